#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sidestep/hardware/camera_calibration.h"
#include "sidestep/hardware/tag_sensor.h"
#include "sidestep/sim/sensors.h"

namespace sidestep::cli {

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

/// Makes the scenario's camera, which stands where it was calibrated to stand.
/// @param today YYYY-MM-DD, UTC.
/// @throws InputError, blaming --calibration, for a sensor that is no camera, and a camera that is
///   not the calibrated one or was calibrated too long ago.
sim::SensorMaker CalibratedCamera(const scenarios::Scenario& scenario,
                                  const hardware::CameraCalibration& calibration,
                                  const std::string& today);

/// What a sensor of tags has to know of a scenario: its moving bodies that bear tags, and, by the
/// tags of static boxes, where the camera must see them.
hardware::TagSensorOptions TagSensorOptionsOf(const scenarios::Scenario& scenario);

}  // namespace sidestep::cli
