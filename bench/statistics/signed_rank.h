#pragma once

#include <vector>

namespace sidestep::bench {

/// What the paired differences of two treatments say.
struct SignedRankResult {
  int num_differences = 0;  ///< that are not zero; only these are ranked
  int num_zero = 0;
  double positive_rank_sum = 0;  ///< Wilcoxon's V; ties share their mean rank
  /// Two-sided, conditional on the ties; exact for up to 1000 differences, else by the normal
  /// approximation.
  double p = 1;
  /// Hodges and Lehmann's estimate of the shift: the median of all pairwise means of the
  /// differences, zeros included. NaN without differences.
  double shift = 0;
};

/// Wilcoxon's signed-rank test. Up to n = 1000 the null distribution is counted out in O(n^3).
/// Source: M. Hollander, D. Wolfe, "Nonparametric Statistical Methods", 2nd ed. 1999, chapter 3.
/// @throws std::invalid_argument for a difference that is not finite.
SignedRankResult TestSignedRanks(const std::vector<double>& differences);

}  // namespace sidestep::bench
