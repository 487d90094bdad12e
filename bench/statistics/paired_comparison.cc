#include "sidestep/bench/statistics/paired_comparison.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/statistics/resampling.h"
#include "sidestep/bench/statistics/signed_rank.h"

namespace sidestep::bench {
namespace {

constexpr double kSignificant = 0.05;

std::vector<double> CostDifferences(const std::vector<PairedCase>& cases) {
  std::vector<double> differences;
  for (const PairedCase& one : cases) {
    const double difference = one.first_cost - one.second_cost;
    if (std::isfinite(difference)) differences.push_back(difference);
  }
  return differences;
}

double RateDifference(const std::vector<PairedCase>& cases) {
  int difference = 0;
  for (const PairedCase& one : cases) {
    difference += static_cast<int>(one.first_succeeds) - static_cast<int>(one.second_succeeds);
  }
  return static_cast<double>(difference) / static_cast<double>(cases.size());
}

double MedianCostDifference(const std::vector<PairedCase>& cases) {
  return Quantile(CostDifferences(cases), 0.5);
}

// Counts into a comparison of either kind.
template <class Comparison>
void CountSuccesses(const std::vector<PairedCase>& cases, Comparison& comparison) {
  comparison.num_rows = static_cast<int>(cases.size());
  for (const PairedCase& one : cases) {
    comparison.only_first += one.first_succeeds && !one.second_succeeds ? 1 : 0;
    comparison.only_second += one.second_succeeds && !one.first_succeeds ? 1 : 0;
  }
}

CostComparison CompareCosts(const std::vector<PairedCase>& cases) {
  const std::vector<double> differences = CostDifferences(cases);
  CostComparison comparison;
  comparison.num_rows = static_cast<int>(cases.size());
  comparison.num_not_finite = comparison.num_rows - static_cast<int>(differences.size());
  const SignedRankResult ranks = TestSignedRanks(differences);
  comparison.shift = ranks.shift;
  comparison.p = ranks.p;
  return comparison;
}

LevelComparison CompareAtLevel(double level, const std::vector<PairedCase>& cases) {
  LevelComparison comparison;
  comparison.level = level;
  CountSuccesses(cases, comparison);
  comparison.mcnemar_p = McNemarExactP(comparison.only_first, comparison.only_second);
  comparison.all = CompareCosts(cases);
  std::vector<PairedCase> both;
  std::copy_if(cases.begin(), cases.end(), std::back_inserter(both),
               [](const PairedCase& one) { return one.first_succeeds && one.second_succeeds; });
  comparison.both_succeed = CompareCosts(both);
  return comparison;
}

// Adjusts the p-values that `p` finds in each of `levels` and writes them to `adjusted`.
template <class P, class Adjusted>
void AdjustOverLevels(std::vector<LevelComparison>& levels, const P& p, const Adjusted& adjusted) {
  std::vector<double> p_values;
  for (LevelComparison& level : levels) p_values.push_back(p(level));
  const std::vector<double> holm = HolmAdjusted(p_values);
  for (std::size_t i = 0; i < levels.size(); ++i) adjusted(levels[i]) = holm[i];
}

Interval Bootstrap(const std::map<int, std::vector<PairedCase>>& by_cluster,
                   double (*statistic)(const std::vector<PairedCase>&)) {
  std::vector<const std::vector<PairedCase>*> clusters;
  for (const auto& [cluster, cases] : by_cluster) clusters.push_back(&cases);
  return BootstrapOverClusters(
      static_cast<int>(clusters.size()),
      [&](const std::vector<int>& sample) {
        std::vector<PairedCase> drawn;
        for (const int c : sample) {
          const std::vector<PairedCase>& cluster = *clusters[static_cast<std::size_t>(c)];
          drawn.insert(drawn.end(), cluster.begin(), cluster.end());
        }
        return statistic(drawn);
      },
      kBootstrapDraws, kBootstrapSeed);
}

}  // namespace

int PairedComparison::CountSignificantOutcomes() const {
  return static_cast<int>(std::count_if(
      levels.begin(), levels.end(),
      [](const LevelComparison& level) { return level.mcnemar_p_holm < kSignificant; }));
}

int PairedComparison::CountSignificantCosts(CostComparison LevelComparison::*costs) const {
  return static_cast<int>(std::count_if(
      levels.begin(), levels.end(),
      [costs](const LevelComparison& level) { return (level.*costs).p_holm < kSignificant; }));
}

bool PairedComparison::CanBeSignificant() const {
  return std::any_of(levels.begin(), levels.end(), [this](const LevelComparison& level) {
    return McNemarExactP(level.num_rows, 0) * static_cast<double>(levels.size()) < kSignificant;
  });
}

PairedComparison ComparePaired(const std::vector<PairedCase>& cases) {
  PairedComparison comparison;
  CountSuccesses(cases, comparison);
  std::map<int, std::vector<PairedCase>> by_cluster;
  std::map<double, std::vector<PairedCase>> by_level;
  for (const PairedCase& one : cases) {
    by_cluster[one.cluster].push_back(one);
    by_level[one.level].push_back(one);
  }
  comparison.rate_difference = RateDifference(cases);
  comparison.rate_interval = Bootstrap(by_cluster, &RateDifference);
  comparison.median_cost_difference = MedianCostDifference(cases);
  comparison.cost_interval = Bootstrap(by_cluster, &MedianCostDifference);

  std::vector<LevelComparison>& levels = comparison.levels;
  for (const auto& [level, rows] : by_level) levels.push_back(CompareAtLevel(level, rows));
  AdjustOverLevels(
      levels, [](const LevelComparison& level) { return level.mcnemar_p; },
      [](LevelComparison& level) -> double& { return level.mcnemar_p_holm; });
  for (CostComparison LevelComparison::*const costs :
       {&LevelComparison::all, &LevelComparison::both_succeed}) {
    AdjustOverLevels(
        levels, [costs](const LevelComparison& level) { return (level.*costs).p; },
        [costs](LevelComparison& level) -> double& { return (level.*costs).p_holm; });
  }
  return comparison;
}

}  // namespace sidestep::bench
