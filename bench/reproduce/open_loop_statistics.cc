#include "sidestep/bench/reproduce/open_loop_statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/statistics/resampling.h"
#include "sidestep/bench/statistics/signed_rank.h"

namespace sidestep::bench {
namespace {

constexpr int kDraws = 2000;
constexpr std::uint64_t kSeed = 1;

// One row under two kinds of knowledge.
struct Match {
  int pair;
  double speed_m_s;
  OpenLoopOutcome first, second;

  double CostDifference() const { return first.gp_cost - second.gp_cost; }
};

std::vector<Match> MatchRows(const std::vector<MatchedOutcomes>& rows, sdf::Knowledge first,
                             sdf::Knowledge second) {
  std::vector<Match> matches;
  for (const MatchedOutcomes& row : rows) {
    const auto a = row.runs.find(first), b = row.runs.find(second);
    if (a == row.runs.end() || b == row.runs.end()) continue;
    matches.push_back({row.pair, row.speed_m_s, a->second, b->second});
  }
  return matches;
}

FreeRate Rate(const std::vector<MatchedOutcomes>& rows, sdf::Knowledge knowledge) {
  FreeRate rate;
  rate.knowledge = knowledge;
  for (const MatchedOutcomes& row : rows) {
    const auto run = row.runs.find(knowledge);
    if (run == row.runs.end()) continue;
    ++rate.num_rows;
    rate.num_free += run->second.is_free ? 1 : 0;
    rate.mean_gp_cost += run->second.gp_cost;
  }
  rate.wilson = WilsonInterval(rate.num_free, rate.num_rows);
  rate.mean_gp_cost /= rate.num_rows;
  return rate;
}

void CountFree(const std::vector<Match>& matches, int& only_first, int& only_second) {
  for (const Match& match : matches) {
    only_first += match.first.is_free && !match.second.is_free ? 1 : 0;
    only_second += match.second.is_free && !match.first.is_free ? 1 : 0;
  }
}

CostComparison CompareCosts(const std::vector<Match>& matches) {
  CostComparison comparison;
  comparison.num_rows = static_cast<int>(matches.size());
  std::vector<double> differences;
  for (const Match& match : matches) {
    const double difference = match.CostDifference();
    if (std::isfinite(difference)) differences.push_back(difference);
  }
  comparison.num_not_finite = comparison.num_rows - static_cast<int>(differences.size());
  const SignedRankResult ranks = TestSignedRanks(differences);
  comparison.shift = ranks.shift;
  comparison.p = ranks.p;
  return comparison;
}

SpeedComparison CompareAtSpeed(double speed_m_s, const std::vector<Match>& matches) {
  SpeedComparison comparison;
  comparison.speed_m_s = speed_m_s;
  comparison.num_rows = static_cast<int>(matches.size());
  CountFree(matches, comparison.only_first_free, comparison.only_second_free);
  comparison.mcnemar_p = McNemarExactP(comparison.only_first_free, comparison.only_second_free);
  comparison.all = CompareCosts(matches);
  std::vector<Match> both_free;
  std::copy_if(matches.begin(), matches.end(), std::back_inserter(both_free),
               [](const Match& match) { return match.first.is_free && match.second.is_free; });
  comparison.both_free = CompareCosts(both_free);
  return comparison;
}

// Adjusts the p-values that `p` finds in each of `speeds` and writes them to `adjusted`.
template <class P, class Adjusted>
void AdjustOverSpeeds(std::vector<SpeedComparison>& speeds, const P& p, const Adjusted& adjusted) {
  std::vector<double> p_values;
  for (const SpeedComparison& speed : speeds) p_values.push_back(p(speed));
  const std::vector<double> holm = HolmAdjusted(p_values);
  for (std::size_t i = 0; i < speeds.size(); ++i) adjusted(speeds[i]) = holm[i];
}

double RateDifference(const std::vector<const Match*>& matches) {
  int difference = 0;
  for (const Match* match : matches) {
    difference += static_cast<int>(match->first.is_free) - static_cast<int>(match->second.is_free);
  }
  return static_cast<double>(difference) / static_cast<double>(matches.size());
}

double MedianCostDifference(const std::vector<const Match*>& matches) {
  std::vector<double> differences;
  for (const Match* match : matches) {
    if (std::isfinite(match->CostDifference())) differences.push_back(match->CostDifference());
  }
  return Quantile(std::move(differences), 0.5);
}

KnowledgeComparison Compare(const std::vector<Match>& matches, sdf::Knowledge first,
                            sdf::Knowledge second) {
  KnowledgeComparison comparison;
  comparison.first = first;
  comparison.second = second;
  comparison.num_rows = static_cast<int>(matches.size());
  CountFree(matches, comparison.only_first_free, comparison.only_second_free);

  std::map<int, std::vector<const Match*>> by_pair;
  std::map<double, std::vector<Match>> by_speed;
  std::vector<const Match*> all;
  for (const Match& match : matches) {
    by_pair[match.pair].push_back(&match);
    by_speed[match.speed_m_s].push_back(match);
    all.push_back(&match);
  }
  std::vector<const std::vector<const Match*>*> clusters;
  for (const auto& [pair, cluster] : by_pair) clusters.push_back(&cluster);
  const auto bootstrap = [&](double (*statistic)(const std::vector<const Match*>&)) {
    return BootstrapOverClusters(
        static_cast<int>(clusters.size()),
        [&](const std::vector<int>& sample) {
          std::vector<const Match*> drawn;
          for (const int c : sample) {
            const std::vector<const Match*>& cluster = *clusters[static_cast<std::size_t>(c)];
            drawn.insert(drawn.end(), cluster.begin(), cluster.end());
          }
          return statistic(drawn);
        },
        kDraws, kSeed);
  };
  comparison.rate_difference = RateDifference(all);
  comparison.rate_interval = bootstrap(&RateDifference);
  comparison.median_cost_difference = MedianCostDifference(all);
  comparison.cost_interval = bootstrap(&MedianCostDifference);

  std::vector<SpeedComparison>& speeds = comparison.speeds;
  for (const auto& [speed_m_s, rows] : by_speed) speeds.push_back(CompareAtSpeed(speed_m_s, rows));
  AdjustOverSpeeds(
      speeds, [](const SpeedComparison& s) { return s.mcnemar_p; },
      [](SpeedComparison& s) -> double& { return s.mcnemar_p_holm; });
  for (CostComparison SpeedComparison::*const costs :
       {&SpeedComparison::all, &SpeedComparison::both_free}) {
    AdjustOverSpeeds(
        speeds, [costs](const SpeedComparison& s) { return (s.*costs).p; },
        [costs](SpeedComparison& s) -> double& { return (s.*costs).p_holm; });
  }
  return comparison;
}

}  // namespace

OpenLoopStatistics ComputeOpenLoopStatistics(const std::vector<MatchedOutcomes>& rows,
                                             RowFilter filter,
                                             const OpenLoopExperiment& experiment) {
  const FilteredRows left = Filter(rows, filter, experiment);
  OpenLoopStatistics statistics;
  statistics.filter = filter;
  statistics.num_rows = static_cast<int>(left.rows.size());
  statistics.excluded_by_speed = left.excluded_by_speed;
  statistics.excluded_none_free = left.excluded_none_free;

  std::map<sdf::Knowledge, std::map<double, std::vector<MatchedOutcomes>>> by_speed;
  for (const MatchedOutcomes& row : left.rows) {
    for (const auto& [knowledge, run] : row.runs) by_speed[knowledge][row.speed_m_s].push_back(row);
  }
  for (const auto& [knowledge, speeds] : by_speed) {
    statistics.pooled.push_back(Rate(left.rows, knowledge));
    for (const auto& [speed_m_s, at_speed] : speeds) {
      statistics.by_speed.push_back(Rate(at_speed, knowledge));
      statistics.by_speed.back().speed_m_s = speed_m_s;
    }
  }
  for (auto first = by_speed.begin(); first != by_speed.end(); ++first) {
    for (auto second = by_speed.begin(); second != first; ++second) {
      const std::vector<Match> matches = MatchRows(left.rows, first->first, second->first);
      if (matches.empty()) continue;
      statistics.comparisons.push_back(Compare(matches, first->first, second->first));
    }
  }
  return statistics;
}

}  // namespace sidestep::bench
