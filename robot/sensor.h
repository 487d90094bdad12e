#pragma once

#include <optional>
#include <string>

#include "sidestep/core/observations.h"

namespace sidestep::robot {

/// Something that sees the world, at its own rate.
class Sensor {
 public:
  virtual ~Sensor() = default;

  /// When it has to be read next, because then it captures or a scan arrives: the loop advances the
  /// robot to that time and calls Read. A time that has passed means: at once; if there is nothing
  /// to read then and the time stays in the past, it is asked again a millisecond later.
  virtual EpisodeTime NextDue() const = 0;

  /// At `now`, which never goes back: the next scan that has arrived and has not been read before,
  /// if there is one; its time is that of its capture. Scans come in the order of capture. They
  /// never hold the robot.
  virtual std::optional<Scan> Read(EpisodeTime now) = 0;
};

/// One of several.
struct NamedSensor {
  std::string name;
  Sensor* sensor = nullptr;
};

}  // namespace sidestep::robot
