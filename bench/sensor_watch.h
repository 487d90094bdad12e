#pragma once

#include <optional>
#include <string>

#include "sidestep/core/observations.h"
#include "sidestep/core/time.h"
#include "sidestep/robot/sensor.h"

namespace sidestep::bench {

/// Says when a sensor has to be read, and reads it. One that is overdue and has nothing to give is
/// asked again a millisecond later, so that time goes on whatever it says. Cameras repeat time
/// stamps and go back in them: such scans are counted and left out.
class SensorWatch {
 public:
  /// @param sensor must outlive this.
  explicit SensorWatch(const robot::NamedSensor& sensor)
      : name_(sensor.name), sensor_(sensor.sensor) {}

  const std::string& name() const { return name_; }

  /// May lie in the past: then at once.
  EpisodeTime NextDue() const;

  /// At `now`, which never goes back: the next scan, with the sensor's name, if there is one that
  /// was captured after the one before.
  std::optional<Scan> Read(EpisodeTime now);

  /// Scans that were captured no later than the one before.
  int num_left_out() const { return num_left_out_; }

 private:
  std::string name_;
  robot::Sensor* sensor_;
  std::optional<EpisodeTime> newest_;     // capture of the latest scan
  std::optional<EpisodeTime> ask_again_;  // not before
  int num_left_out_ = 0;
};

}  // namespace sidestep::bench
