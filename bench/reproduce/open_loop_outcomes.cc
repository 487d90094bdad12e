#include "sidestep/bench/reproduce/open_loop_outcomes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sidestep/bench/reproduce/published_columns.h"

namespace sidestep::bench {
namespace {

bool IsExcludedSpeed(const OpenLoopExperiment& experiment, double speed_m_s) {
  return std::any_of(experiment.excluded_speeds_m_s.begin(), experiment.excluded_speeds_m_s.end(),
                     [&](double excluded) { return std::abs(excluded - speed_m_s) < 1e-6; });
}

bool AnyPublishedCaseIsFree(const MatchedOutcomes& row) {
  return std::any_of(std::begin(kPublishedCases), std::end(kPublishedCases),
                     [&](const PublishedCase& entry) {
                       const auto run = row.runs.find(entry.knowledge);
                       return entry.is_published && run != row.runs.end() && run->second.is_free;
                     });
}

}  // namespace

std::vector<MatchedOutcomes> ReadOutcomes(const CsvTable& table) {
  const auto pair = table.Find(kPairColumn), speed = table.Find(kSpeedColumn);
  if (!pair || !speed) throw std::invalid_argument("ReadOutcomes: no column for pair or speed");
  std::vector<MatchedOutcomes> rows;
  for (std::size_t i = 0; i < table.num_rows(); ++i) {
    if (!table.At(i, *pair) || !table.At(i, *speed)) {
      throw std::invalid_argument("ReadOutcomes: a row without pair or speed");
    }
    MatchedOutcomes row{
        static_cast<int>(std::lround(*table.At(i, *pair))), *table.At(i, *speed), {}};
    for (const PublishedCase& entry : kPublishedCases) {
      const auto colliding = table.Find(kCollidingPrefix + std::string(entry.name));
      const auto gp_cost = table.Find(kGpCostPrefix + std::string(entry.name));
      if (!colliding || !table.At(i, *colliding)) continue;
      OpenLoopOutcome& run = row.runs[entry.knowledge];
      run.is_free = *table.At(i, *colliding) == 0;
      run.gp_cost = std::numeric_limits<double>::quiet_NaN();
      if (gp_cost && table.At(i, *gp_cost)) run.gp_cost = *table.At(i, *gp_cost);
    }
    rows.push_back(row);
  }
  return rows;
}

std::string ToString(RowFilter filter) {
  return filter == RowFilter::kAllRows ? "all_rows" : "published_exclusions";
}

bool CanFilter(const std::vector<MatchedOutcomes>& rows, RowFilter filter) {
  if (filter == RowFilter::kAllRows) return true;
  return std::all_of(rows.begin(), rows.end(), [](const MatchedOutcomes& row) {
    return std::all_of(std::begin(kPublishedCases), std::end(kPublishedCases),
                       [&](const PublishedCase& entry) {
                         return !entry.is_published || row.runs.contains(entry.knowledge);
                       });
  });
}

FilteredRows Filter(const std::vector<MatchedOutcomes>& rows, RowFilter filter,
                    const OpenLoopExperiment& experiment) {
  if (filter == RowFilter::kAllRows) return {rows, 0, 0};
  FilteredRows left;
  for (const MatchedOutcomes& row : rows) {
    if (IsExcludedSpeed(experiment, row.speed_m_s)) {
      ++left.excluded_by_speed;
    } else if (!AnyPublishedCaseIsFree(row)) {
      ++left.excluded_none_free;
    } else {
      left.rows.push_back(row);
    }
  }
  return left;
}

}  // namespace sidestep::bench
