#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sidestep/core/time.h"
#include "sidestep/hardware/camera_calibration.h"
#include "sidestep/hardware/tag_sensor.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/sensors.h"

namespace sidestep::cli {

/// Where the pictures come from in which tags are found, when a robot is at the end of a wire.
enum class CameraKind {
  kVirtual,   ///< drawn of the scenario's obstacles, which move as they are prescribed
  kServer,    ///< of the world of the simulated robot server
  kRecorded,  ///< of a folder
  kRealSense
};
struct CameraChoice {
  CameraKind kind = CameraKind::kVirtual;
  std::string of;  ///< the folder, or the serial number
};
/// `virtual`, `server`, `recorded:DIR` or `realsense:SERIAL`. @throws InputError, blaming --camera.
CameraChoice ParseCamera(const std::string& text);

/// How a camera is used.
struct CameraUse {
  CameraChoice choice;
  std::optional<hardware::CameraCalibration> calibration;  ///< else it stands as the scenario says
  std::string robot;                                       ///< the address of the robot
  std::function<void(const hardware::Look&)> on_look;
};

/// A camera that is ready to look, and what is known of it.
struct ReadyCamera {
  sim::SensorMaker make_sensor;        ///< makes one sensor
  std::string description;             ///< for a recording; empty: its obstacles are virtual
  std::optional<EpisodeTime> ends_at;  ///< what is recorded has an end
};

/// Opens the camera of a scenario whose sensor is tag_images; that of a server, which begins its
/// world for the client that drives the robot, when the sensor is made.
/// @param today YYYY-MM-DD, UTC.
/// @throws InputError, blaming --camera or --calibration: for another sensor, a camera that is not
/// there, one that is not the calibrated one or was calibrated too long ago, a real one without
/// calibration.
ReadyCamera OpenTagCamera(const scenarios::Scenario& scenario, const CameraUse& use,
                          const std::string& today);

}  // namespace sidestep::cli
