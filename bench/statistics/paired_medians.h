#pragma once

#include <vector>

#include "sidestep/bench/statistics/proportions.h"

namespace sidestep::bench {

/// A number of one case under two treatments.
struct PairedNumber {
  int cluster = 0;  ///< pairs of one cluster resemble each other
  double first = 0, second = 0;
};

/// What the treatments do to it.
struct PairedMedians {
  int num_pairs = 0;
  double first = 0, second = 0;  ///< medians
  double difference = 0;         ///< the median one, first minus second
  /// Of that, 95 %: a percentile bootstrap over clusters. Of one cluster nothing is known: NaN.
  Interval interval;
};

/// Deterministic: the bootstrap has a fixed seed. Without pairs everything is NaN.
/// @param pairs of finite numbers.
PairedMedians ComparePairedMedians(const std::vector<PairedNumber>& pairs);

}  // namespace sidestep::bench
