#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/run_row.h"
#include "sidestep/bench/summary_page.h"

namespace sidestep::bench {

/// A Markdown table of what the values of the factor across do to the same episodes: for each value
/// of the factor down, and for all together, each value across beside the first one. Episodes are
/// paired that agree in all other factors; what could not be run is left out, with its pair.
///
/// A row says in how many pairs the goal was reached, and medians: of the least clearance of all,
/// of time and jerk where the goal was reached. Beside each stands the difference from the first
/// value, this one minus that one: of the share of goals, and the median difference within pairs
/// (of time and jerk: of pairs that both reached the goal). Intervals of 95 % are those of the
/// report: of shares bench/statistics/paired_rates.h, of medians bench/statistics/paired_medians.h,
/// with seeds as clusters, since episodes of one seed resemble each other.
/// Empty where the factor across does not vary.
std::string PairedTable(const std::vector<RunRow>& rows, const TableAxes& axes);

}  // namespace sidestep::bench
