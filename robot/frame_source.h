#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sidestep/core/time.h"
#include "sidestep/robot/camera_image.h"

namespace sidestep::robot {

/// One picture of a camera.
struct Frame {
  EpisodeTime t;            ///< the middle of its exposure, not when it arrived
  std::int64_t number = 0;  ///< counts what the camera took; one that is left out was lost
  std::string serial;       ///< of the camera
  CameraIntrinsics camera;
  GreyImage image;
};

/// A camera: real, rendered, or recorded. Read as a Sensor is (robot/sensor.h).
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// When it has to be read next; a time that has passed means: at once.
  virtual EpisodeTime NextDue() const = 0;

  /// At `now`, which never goes back: the next frame that has arrived and has not been read before,
  /// if there is one. Frames come in the order of capture.
  /// @throws RobotError if the camera is gone.
  virtual std::optional<Frame> Read(EpisodeTime now) = 0;
};

}  // namespace sidestep::robot
