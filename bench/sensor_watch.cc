#include "sidestep/bench/sensor_watch.h"

#include <algorithm>
#include <cmath>

namespace sidestep::bench {

EpisodeTime SensorWatch::NextDue() const {
  const EpisodeTime due = sensor_->NextDue();
  return ask_again_ ? std::max(due, *ask_again_) : due;
}

std::optional<Scan> SensorWatch::Read(EpisodeTime now) {
  constexpr HorizonOffset kAskAgain(1e-3);
  std::optional<Scan> scan = sensor_->Read(now);
  const bool is_taken = scan && !HasClockJumped(*scan, now) && (!newest_ || scan->t > *newest_);
  if (!is_taken) {
    if (scan) ++num_left_out_;
    if (sensor_->NextDue() <= now) ask_again_ = now + kAskAgain;
    return std::nullopt;
  }
  newest_ = scan->t;
  scan->sensor = name_;
  return scan;
}

bool SensorWatch::HasClockJumped(const Scan& scan, EpisodeTime now) {
  if (!clock_) return false;
  const double jump_s = clock_->Observe(scan.t, now);
  const bool had_jumped = std::exchange(has_jumped_, std::abs(jump_s) > ClockWatch::kJump_s);
  if (has_jumped_ && !had_jumped) new_jump_s_ = jump_s;
  return has_jumped_;
}

}  // namespace sidestep::bench
