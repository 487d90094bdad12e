#pragma once

#include <vector>

#include "sidestep/bench/statistics/proportions.h"

namespace sidestep::bench {

/// Newcombe's interval of 95 % for the difference of two rates of matched pairs, first minus
/// second: that of the squares of Wilson's intervals, with their correlation.
/// Source: R. Newcombe, "Improved confidence intervals for the difference between binomial
/// proportions based on paired data", Statistics in Medicine 17:2635-2650, 1998, method 10.
/// @throws std::invalid_argument for negative counts or no pairs.
Interval NewcombePairedInterval(int both, int only_first, int only_second, int neither);

/// What came of one pair.
struct PairedOutcome {
  int cluster = 0;  ///< pairs of one cluster resemble each other
  bool first = false, second = false;
};

/// Success under two treatments of the same cases.
struct PairedRates {
  int num_pairs = 0, num_clusters = 0;
  int first_successes = 0, second_successes = 0;
  int only_first = 0, only_second = 0;
  double difference = 0;  ///< of the rates, first minus second
  /// Of the difference, 95 %: Newcombe's where every cluster is one pair, or all clusters agree
  /// (then by their number); else a percentile bootstrap over clusters. Of one cluster with several
  /// pairs nothing is known: NaN.
  Interval interval;
  /// Two-sided, exact: whether the treatments could be swapped in each cluster. Where every cluster
  /// is one pair that is McNemar's exact test.
  double p = 1;
  double least_p = 1;  ///< what p would be if all clusters differed in the same sense
};

/// Deterministic: the bootstrap has a fixed seed. @throws std::invalid_argument without pairs.
PairedRates ComparePairedRates(const std::vector<PairedOutcome>& pairs);

/// The share of all ways to give each difference a sign by which their sum is at least as far from
/// 0 as it is. Source: R. Fisher, "The Design of Experiments", 1935, section 21. Normal where the
/// sums are too many to count.
double SignFlipP(const std::vector<int>& differences);

}  // namespace sidestep::bench
