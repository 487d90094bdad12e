#pragma once

#include <string>

#include "sidestep/hardware/camera_file.h"

namespace sidestep::hardware {

struct RealSenseOptions {
  std::string serial;
  /// The left infrared imager, its projector off: it exposes all rows at once, where the colour
  /// camera skews what moves.
  bool infrared = true;
  int width = 1280, height = 720, rate_hz = 30;
  double exposure_s = 0.008;  ///< always the same: what moves must not smear more in the dark
  /// From the middle of the exposure until a frame is read: measure it. The camera's own stamps
  /// need a patched kernel.
  double latency_s = 0.06;
};

/// A RealSense camera of the series D400, by librealsense2.
/// @throws InputError if this build is without the library, there is no such camera, or its lens is
///   described in a way that robot/camera_image.h has not. What it gives throws RobotError once it
///   is unplugged.
OpenCamera OpenRealSense(const RealSenseOptions& options);

}  // namespace sidestep::hardware
