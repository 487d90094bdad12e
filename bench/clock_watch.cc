#include "sidestep/bench/clock_watch.h"

#include <algorithm>

namespace sidestep::bench {

double ClockWatch::Observe(EpisodeTime capture, EpisodeTime now) {
  ages_s_[count_++ % kScans] = (now - capture).seconds();
  if (count_ < kScans) return 0;
  const double least_s = *std::min_element(ages_s_.begin(), ages_s_.end());
  if (count_ == kScans) at_first_s_ = least_s;
  return least_s - at_first_s_;
}

}  // namespace sidestep::bench
