#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sidestep/hardware/tag_sensor.h"
#include "sidestep/sim/sensors.h"

namespace sidestep::cli {

/// The sensor that finds tags in pictures.
inline constexpr const char* kTagImages = "tag_images";

/// Every sensor that a scenario may name, sorted: those of sim/ and `tag_images`, which is put
/// together here, from pictures that render/ draws and what hardware/ finds in them.
std::vector<std::string> SensorNames();

/// What one sees, in a line. @throws std::invalid_argument for an unknown name.
std::string MeaningOfSensor(const std::string& name);

/// Makes the scenario's sensor. @param world must outlive it.
/// @throws InputError for a name that is not known, settings of another sensor, or tags that this
///   build cannot find.
std::unique_ptr<robot::Sensor> MakeSensor(const scenarios::Scenario& scenario,
                                          const sim::World& world);

/// What a sensor of tags has to know of a scenario: its moving bodies that bear tags, and, by the
/// tags of static boxes, where the camera must see them.
hardware::TagSensorOptions TagSensorOptionsOf(const scenarios::Scenario& scenario);

/// What finds those tags in the pictures of any camera. @param options of the scenario, perhaps
/// with another place of the camera. @param world holds what stands still.
std::unique_ptr<robot::Sensor> MakeTagSensor(std::unique_ptr<robot::FrameSource> frames,
                                             hardware::TagSensorOptions options,
                                             const scenarios::Scenario& scenario,
                                             const sim::World& world);

}  // namespace sidestep::cli
