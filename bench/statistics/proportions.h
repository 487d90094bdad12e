#pragma once

namespace sidestep::bench {

/// An interval estimate.
struct Interval {
  double low = 0, high = 0;
};

/// Wilson's score interval for a rate of `successes` in `trials`, without continuity correction.
/// Source: R. Newcombe, "Two-sided confidence intervals for the single proportion", Statistics in
/// Medicine 17:857-872, 1998, method 3.
/// @param z the normal quantile; 1.959964 for 95 %.
/// @throws std::invalid_argument unless 0 <= successes <= trials and trials >= 1.
Interval WilsonInterval(int successes, int trials, double z = 1.959963984540054);

/// McNemar's exact conditional test of two matched binary outcomes: the two-sided p-value that
/// among the pairs that differ, either outcome is as likely. Pairs that agree say nothing.
/// Source: M. Fagerland, S. Lydersen, P. Laake, "The McNemar test for binary matched-pairs data",
/// BMC Medical Research Methodology 13:91, 2013.
/// @param only_first, only_second in how many pairs only the first (only the second) succeeded.
/// @throws std::invalid_argument for negative numbers.
double McNemarExactP(int only_first, int only_second);

}  // namespace sidestep::bench
