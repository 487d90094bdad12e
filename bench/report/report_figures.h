#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "sidestep/bench/report/comparison.h"
#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/report/run_table.h"

namespace sidestep::bench {

/// Runs at one level of a factor, of which one figure is asked.
struct Share {
  int goals = 0, runs = 0;  ///< those that failed left out
  int failed = 0;
  Interval interval;  ///< of goals among runs, Wilson's, 95 %; NaN without runs
};
/// Of runs at `level` of a factor, or all for factor -1, that are also at another level of another.
Share ShareOf(const RunTable& runs, int factor, int level, int other_factor = -1,
              int other_level = -1);

/// The share of goals over a factor's levels, a series for each of `groups` (of another factor; -1
/// without groups), with intervals: a line and bands where the factor's levels are numbers, else
/// points with bars.
Panel RatePanel(const RunTable& runs, int factor, int group_factor, const std::vector<int>& groups);

/// A metric over a factor's levels likewise: medians, with bounds that hold the middle half of
/// runs.
Panel MetricPanel(const RunTable& runs, const std::string& column, const std::string& label,
                  double scale, int factor, int group_factor, const std::vector<int>& groups);

/// The distribution over runs of a column, a curve for each of a factor's `groups`.
/// @param scale of the column's numbers.
Panel DistributionPanel(const RunTable& runs, const std::string& column, const std::string& label,
                        double scale, bool log_x, int group_factor, const std::vector<int>& groups);

/// Whether a column holds a number at all.
bool HasNumbers(const RunTable& runs, const std::string& column);

/// Of the runs for which `is_asked(run)` is true, the finite numbers of a column, sorted.
template <class IsAsked>
std::vector<double> SortedNumbers(const RunTable& runs, const std::string& column,
                                  const IsAsked& is_asked) {
  std::vector<double> numbers;
  const auto found = runs.numbers.find(column);
  if (found == runs.numbers.end()) return numbers;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (std::isfinite(found->second[run]) && is_asked(run)) numbers.push_back(found->second[run]);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace sidestep::bench
