#pragma once

#include <memory>
#include <string>
#include <vector>

#include "robot/sensor.h"
#include "scenarios/scenario.h"
#include "sim/world.h"

namespace sidestep {

/// The simulated sensors there are, sorted.
std::vector<std::string> SensorNames();

/// Makes the scenario's sensor. @param world must outlive it.
/// @throws InputError for a name that is not known.
std::unique_ptr<Sensor> MakeSensor(const Scenario& scenario, const World& world);

}  // namespace sidestep
