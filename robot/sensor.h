#pragma once

#include <optional>

#include "core/observations.h"

namespace sidestep {

/// Something that sees the world as points, at its own rate.
class Sensor {
 public:
  virtual ~Sensor() = default;

  /// When the next scan will be captured; the loop advances the robot to that time and then reads.
  virtual EpisodeTime NextCapture() const = 0;

  /// The newest scan that has not been read before, if there is one. It never holds the robot.
  virtual std::optional<Scan> Read() = 0;
};

}  // namespace sidestep
