#include "sidestep/bench/sensor_watch.h"

#include <algorithm>

namespace sidestep::bench {

EpisodeTime SensorWatch::NextDue() const {
  const EpisodeTime due = sensor_->NextDue();
  return ask_again_ ? std::max(due, *ask_again_) : due;
}

std::optional<Scan> SensorWatch::Read(EpisodeTime now) {
  constexpr HorizonOffset kAskAgain(1e-3);
  std::optional<Scan> scan = sensor_->Read(now);
  const bool is_new = scan && (!newest_ || scan->t > *newest_);
  if (!is_new) {
    if (scan) ++num_left_out_;
    if (sensor_->NextDue() <= now) ask_again_ = now + kAskAgain;
    return std::nullopt;
  }
  newest_ = scan->t;
  scan->sensor = name_;
  return scan;
}

}  // namespace sidestep::bench
