#pragma once

#include <vector>

#include "sidestep/bench/statistics/proportions.h"

namespace sidestep::bench {

/// One case under two treatments.
struct PairedCase {
  int cluster = 0;  ///< what else it shares its kind with: cases of one cluster resemble each other
  double level = 0;  ///< of the factor that is varied; cases at one level are independent
  bool first_succeeds = false, second_succeeds = false;
  double first_cost = 0, second_cost = 0;  ///< not finite: there is none
};

/// Costs of matched cases, first minus second.
struct CostComparison {
  int num_rows = 0;
  int num_not_finite = 0;  ///< cases that could not be compared
  double shift = 0;        ///< Hodges and Lehmann's; NaN without cases
  double p = 1;            ///< Wilcoxon's signed ranks, exact
  double p_holm = 1;       ///< adjusted over the levels of the comparison
};

/// Two treatments at one level.
struct LevelComparison {
  double level = 0;
  int num_rows = 0;
  int only_first = 0, only_second = 0;  ///< in so many cases only this one succeeds
  double mcnemar_p = 1, mcnemar_p_holm = 1;
  CostComparison all, both_succeed;  ///< of all cases; of those in which both succeed
};

/// Two treatments over all levels. Cases of a cluster resemble each other, so intervals (95 %) come
/// from a bootstrap over clusters, and there is no pooled test.
struct PairedComparison {
  int num_rows = 0;
  int only_first = 0, only_second = 0;
  double rate_difference = 0;  ///< of the share of successes, first minus second
  Interval rate_interval;
  double median_cost_difference = 0;  ///< first minus second, of finite ones; NaN without any
  Interval cost_interval;
  std::vector<LevelComparison> levels;  ///< ascending

  /// At how many levels a p-value is below 0.05, of the adjusted ones.
  int CountSignificantOutcomes() const;
  int CountSignificantCosts(CostComparison LevelComparison::*costs) const;
  /// Whether the smallest p-value of McNemar's that there is, all pairs differing in the same
  /// sense, would survive the adjustment at some level. If not, look at the intervals.
  bool CanBeSignificant() const;
};

/// Deterministic: the bootstrap has a fixed seed.
/// @throws std::invalid_argument without cases.
PairedComparison ComparePaired(const std::vector<PairedCase>& cases);

}  // namespace sidestep::bench
