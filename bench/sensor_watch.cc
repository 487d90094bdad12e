#include "sidestep/bench/sensor_watch.h"

#include <algorithm>
#include <stdexcept>

namespace sidestep::bench {

EpisodeTime SensorWatch::NextDue() const {
  const EpisodeTime due = sensor_.NextDue();
  return ask_again_ ? std::max(due, *ask_again_) : due;
}

std::optional<Scan> SensorWatch::Read(EpisodeTime now) {
  constexpr HorizonOffset kAskAgain(1e-3);
  std::optional<Scan> scan = sensor_.Read();
  if (!scan) {
    if (sensor_.NextDue() <= now) ask_again_ = now + kAskAgain;
    return scan;
  }
  if (newest_ && scan->t <= *newest_) {
    throw std::runtime_error("the sensor's scans do not come in the order of their capture");
  }
  newest_ = scan->t;
  return scan;
}

}  // namespace sidestep::bench
