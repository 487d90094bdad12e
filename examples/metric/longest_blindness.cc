// A metric: the longest time between two scans. Copy this file to bench/metrics/ and add the line
// of metrics.def beside it to bench/metrics/metrics.def.
#include <algorithm>
#include <limits>

#include "sidestep/record/recording.h"

namespace sidestep::bench {

double LongestBlindness(const record::Recording& recording) {
  const auto& scans = recording.observations;
  if (scans.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  double longest_s = 0;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    longest_s = std::max(longest_s, (scans[i].t_arrival - scans[i - 1].t_arrival).seconds());
  }
  return longest_s;
}

}  // namespace sidestep::bench
