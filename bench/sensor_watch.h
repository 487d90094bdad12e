#pragma once

#include <optional>

#include "sidestep/core/observations.h"
#include "sidestep/core/time.h"
#include "sidestep/robot/sensor.h"

namespace sidestep::bench {

/// Says when a sensor has to be read, and reads it. One that is overdue and has nothing to give is
/// asked again a millisecond later, so that time goes on whatever it says.
class SensorWatch {
 public:
  /// @param sensor must outlive this.
  explicit SensorWatch(robot::Sensor& sensor) : sensor_(sensor) {}

  /// May lie in the past: then at once.
  EpisodeTime NextDue() const;

  /// At `now`, which never goes back. @throws std::runtime_error for a scan that was not captured
  /// after the one before.
  std::optional<Scan> Read(EpisodeTime now);

  bool has_seen() const { return newest_.has_value(); }

 private:
  robot::Sensor& sensor_;
  std::optional<EpisodeTime> newest_;     // capture of the latest scan
  std::optional<EpisodeTime> ask_again_;  // not before
};

}  // namespace sidestep::bench
