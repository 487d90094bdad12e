#include "sidestep/bench/metrics/safety_metrics.h"

#include <algorithm>
#include <limits>

namespace sidestep::bench {

double FirstContact(const record::Recording& recording) {
  for (const TruthSample& sample : recording.truth) {
    if (sample.in_contact) return sample.contact_s;
  }
  return kNoContact;
}

double MinClearance(const record::Recording& recording) {
  if (recording.truth.empty()) return std::numeric_limits<double>::quiet_NaN();
  double least = std::numeric_limits<double>::infinity();
  for (const TruthSample& sample : recording.truth) least = std::min(least, sample.clearance_m);
  return least;
}

double Replans(const record::Recording& recording) {
  return static_cast<double>(recording.cycles.size());
}

double PlansAccepted(const record::Recording& recording) {
  return static_cast<double>(std::count_if(recording.cycles.begin(), recording.cycles.end(),
                                           [](const CycleRecord& c) { return c.accepted; }));
}

}  // namespace sidestep::bench
