#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sidestep/robot/sensor.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// The simulated sensors there are, sorted.
std::vector<std::string> SensorNames();

/// What one sees, in a line. @throws std::invalid_argument for an unknown name.
std::string MeaningOfSensor(const std::string& name);

/// @param settings the map that the scenario's sensor needs, e.g. `tags`, or may have: `noise?`;
/// empty: none. @throws InputError if it is missing, or one of another sensor is there.
void CheckSensorSettings(const scenarios::Scenario& scenario, std::string_view settings);

/// Makes a scenario's sensor in a world, which must outlive it: of several, each from a scenario
/// that has it alone (scenarios::WithSensor).
using SensorMaker =
    std::function<std::unique_ptr<robot::Sensor>(const scenarios::Scenario&, const World&)>;

/// Makes the scenario's sensor. @param world must outlive it.
/// @throws InputError for a name that is not known, or settings of another sensor.
std::unique_ptr<robot::Sensor> MakeSensor(const scenarios::Scenario& scenario, const World& world);

}  // namespace sidestep::sim
