#pragma once

#include <span>
#include <string>

#include "sidestep/record/recording.h"

namespace sidestep::bench {

/// One number about an episode, from its recording alone. NaN where it does not apply.
struct Metric {
  const char* name;  ///< with its unit as a suffix, as in result files
  const char* unit;  ///< "1" for a ratio, "count" for a whole number
  bool lower_is_better;
  const char* meaning;  ///< one line
  double (*compute)(const record::Recording&);
};

/// Every metric, in the order of reports. To add one: metrics.def.
std::span<const Metric> Metrics();

/// Fills in all of them.
void ComputeMetrics(record::Recording& recording);

}  // namespace sidestep::bench
