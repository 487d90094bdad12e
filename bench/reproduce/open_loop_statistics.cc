#include "sidestep/bench/reproduce/open_loop_statistics.h"

#include <map>
#include <utility>

namespace sidestep::bench {
namespace {

using Runs = std::vector<OpenLoopOutcome>;

FreeRate FreeRateOf(sdf::Knowledge knowledge, const Runs& runs) {
  FreeRate rate;
  rate.knowledge = knowledge;
  rate.num_rows = static_cast<int>(runs.size());
  for (const OpenLoopOutcome& run : runs) {
    rate.num_free += run.is_free ? 1 : 0;
    rate.mean_gp_cost += run.gp_cost;
  }
  rate.wilson = WilsonInterval(rate.num_free, rate.num_rows);
  rate.mean_gp_cost /= rate.num_rows;
  return rate;
}

std::vector<PairedCase> MatchRows(const std::vector<MatchedOutcomes>& rows, sdf::Knowledge first,
                                  sdf::Knowledge second) {
  std::vector<PairedCase> matches;
  for (const MatchedOutcomes& row : rows) {
    const auto a = row.runs.find(first), b = row.runs.find(second);
    if (a == row.runs.end() || b == row.runs.end()) continue;
    matches.push_back({row.pair, row.speed_m_s, a->second.is_free, b->second.is_free,
                       a->second.gp_cost, b->second.gp_cost});
  }
  return matches;
}

}  // namespace

std::vector<FreeRate> FreeRatesBySpeed(const std::vector<MatchedOutcomes>& rows) {
  std::map<std::pair<sdf::Knowledge, double>, Runs> groups;
  for (const MatchedOutcomes& row : rows) {
    for (const auto& [knowledge, run] : row.runs) {
      groups[{knowledge, row.speed_m_s}].push_back(run);
    }
  }
  std::vector<FreeRate> rates;
  for (const auto& [group, runs] : groups) {
    rates.push_back(FreeRateOf(group.first, runs));
    rates.back().speed_m_s = group.second;
  }
  return rates;
}

OpenLoopStatistics ComputeOpenLoopStatistics(const std::vector<MatchedOutcomes>& rows,
                                             RowFilter filter,
                                             const OpenLoopExperiment& experiment) {
  const FilteredRows left = Filter(rows, filter, experiment);
  OpenLoopStatistics statistics;
  statistics.filter = filter;
  statistics.num_rows = static_cast<int>(left.rows.size());
  statistics.excluded_by_speed = left.excluded_by_speed;
  statistics.excluded_none_free = left.excluded_none_free;
  statistics.by_speed = FreeRatesBySpeed(left.rows);

  std::map<sdf::Knowledge, Runs> runs;
  for (const MatchedOutcomes& row : left.rows) {
    for (const auto& [knowledge, run] : row.runs) runs[knowledge].push_back(run);
  }
  for (auto first = runs.begin(); first != runs.end(); ++first) {
    statistics.pooled.push_back(FreeRateOf(first->first, first->second));
    for (auto second = runs.begin(); second != first; ++second) {
      const std::vector<PairedCase> matches = MatchRows(left.rows, first->first, second->first);
      if (matches.empty()) continue;
      statistics.comparisons.push_back({ComparePaired(matches), first->first, second->first});
    }
  }
  return statistics;
}

}  // namespace sidestep::bench
