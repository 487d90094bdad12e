#pragma once

#include <optional>
#include <string>
#include <utility>

#include "sidestep/bench/clock_watch.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/time.h"
#include "sidestep/robot/sensor.h"

namespace sidestep::bench {

/// Says when a sensor has to be read, and reads it. One that is overdue and has nothing to give is
/// asked again a millisecond later, so that time goes on whatever it says. Cameras repeat time
/// stamps and go back in them: such scans are counted and left out. So are those of a sensor whose
/// clock and ours have jumped against each other (bench/clock_watch.h): their ages mean nothing.
class SensorWatch {
 public:
  /// @param sensor must outlive this. @param has_own_clock or goes by ours, as what is simulated.
  SensorWatch(const robot::NamedSensor& sensor, bool has_own_clock)
      : name_(sensor.name), sensor_(sensor.sensor) {
    if (has_own_clock) clock_.emplace();
  }

  const std::string& name() const { return name_; }

  /// May lie in the past: then at once.
  EpisodeTime NextDue() const;

  /// At `now`, which never goes back: the next scan, with the sensor's name, if there is one that
  /// was captured after the one before.
  std::optional<Scan> Read(EpisodeTime now);

  /// The scan that was read is of no use.
  void LeaveOut() { ++num_left_out_; }

  /// Scans that were captured no later than the one before, or by a clock that has jumped, or that
  /// were of no use.
  int num_left_out() const { return num_left_out_; }

  /// By how much the clocks have jumped, where they have since the last call [s].
  std::optional<double> TakeClockJump() { return std::exchange(new_jump_s_, std::nullopt); }

 private:
  bool HasClockJumped(const Scan& scan, EpisodeTime now);

  std::string name_;
  robot::Sensor* sensor_;
  std::optional<EpisodeTime> newest_;     // capture of the latest scan
  std::optional<EpisodeTime> ask_again_;  // not before
  int num_left_out_ = 0;
  std::optional<ClockWatch> clock_;
  bool has_jumped_ = false;
  std::optional<double> new_jump_s_;
};

}  // namespace sidestep::bench
