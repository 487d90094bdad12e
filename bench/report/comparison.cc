#include "sidestep/bench/report/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "sidestep/bench/outcome.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/bench/statistics/resampling.h"

namespace sidestep::bench {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kMostDraws = 2000, kFewestDraws = 200;
constexpr double kMostDrawnPairs = 2e7;
constexpr std::uint64_t kSeed = 1;

// What a pair shares: the levels of all other factors, and the seed.
std::vector<std::int64_t> AllElse(const RunTable& runs, std::size_t run, int factor) {
  std::vector<std::int64_t> key = {runs.seed[run]};
  for (std::size_t f = 0; f < runs.levels.size(); ++f) {
    if (static_cast<int>(f) != factor) key.push_back(runs.levels[f][run]);
  }
  return key;
}

double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

// The middle of many, by selection.
double FastMedian(std::vector<double>& values) {
  if (values.empty()) return kNone;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

MetricComparison CompareMetric(const std::vector<double>& of, const std::vector<double>& with,
                               const std::vector<int>& cluster) {
  MetricComparison comparison;
  comparison.num_pairs = static_cast<int>(of.size());
  comparison.of = Median(of);
  comparison.with = Median(with);
  std::vector<double> differences;
  std::map<int, std::vector<double>> by_cluster;
  for (std::size_t i = 0; i < of.size(); ++i) {
    differences.push_back(of[i] - with[i]);
    by_cluster[cluster[i]].push_back(differences.back());
  }
  comparison.difference = Median(differences);
  comparison.interval = {kNone, kNone};
  if (by_cluster.size() < 2) return comparison;
  std::vector<const std::vector<double>*> clusters;
  for (const auto& [name, values] : by_cluster) clusters.push_back(&values);
  const auto median = [&](const std::vector<int>& sample) {
    std::vector<double> drawn;
    drawn.reserve(differences.size());
    for (const int c : sample) {
      const std::vector<double>& values = *clusters[static_cast<std::size_t>(c)];
      drawn.insert(drawn.end(), values.begin(), values.end());
    }
    return FastMedian(drawn);
  };
  const int draws = std::clamp(static_cast<int>(kMostDrawnPairs / static_cast<double>(of.size())),
                               kFewestDraws, kMostDraws);
  comparison.interval =
      BootstrapOverClusters(static_cast<int>(clusters.size()), median, draws, kSeed);
  return comparison;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> PairsOf(const RunTable& runs,
                                                         const Question& question) {
  const std::vector<int>& level = runs.levels[static_cast<std::size_t>(question.factor)];
  std::map<std::vector<std::int64_t>, std::size_t> others;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (level[run] == question.with) others.emplace(AllElse(runs, run, question.factor), run);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (level[run] != question.of) continue;
    const auto found = others.find(AllElse(runs, run, question.factor));
    if (found != others.end()) pairs.emplace_back(run, found->second);
  }
  return pairs;
}

Comparison Compare(const RunTable& runs, const Question& question,
                   const std::vector<ComparedMetric>& metrics) {
  Comparison comparison;
  comparison.question = question;
  const auto all_pairs = PairsOf(runs, question);
  const std::vector<int>& level = runs.levels[static_cast<std::size_t>(question.factor)];
  const auto at = std::count_if(level.begin(), level.end(),
                                [&](int l) { return l == question.of || l == question.with; });
  comparison.num_unpaired = static_cast<int>(at) - 2 * static_cast<int>(all_pairs.size());
  comparison.by_seed = std::set<std::int64_t>(runs.seed.begin(), runs.seed.end()).size() > 1;

  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<PairedOutcome> outcomes;
  std::map<std::int64_t, int> seeds;
  const std::string goal = ToString(Outcome::kGoal);
  for (const auto& [of, with] : all_pairs) {
    if (runs.Is(of, kFailed) || runs.Is(with, kFailed)) {
      ++comparison.num_left_out;
      continue;
    }
    const int cluster =
        comparison.by_seed
            ? seeds.emplace(runs.seed[of], static_cast<int>(seeds.size())).first->second
            : static_cast<int>(pairs.size());
    pairs.emplace_back(of, with);
    outcomes.push_back({cluster, runs.Is(of, goal), runs.Is(with, goal)});
  }
  if (pairs.empty()) return comparison;
  comparison.rates = ComparePairedRates(outcomes);
  for (const ComparedMetric& metric : metrics) {
    const auto column = runs.numbers.find(metric.column);
    if (column == runs.numbers.end()) continue;
    std::vector<double> of, with;
    std::vector<int> cluster;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double a = column->second[pairs[i].first], b = column->second[pairs[i].second];
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      if (metric.goals_only && !(outcomes[i].first && outcomes[i].second)) continue;
      of.push_back(a);
      with.push_back(b);
      cluster.push_back(outcomes[i].cluster);
    }
    if (of.empty()) continue;
    comparison.metrics.push_back(CompareMetric(of, with, cluster));
    comparison.metrics.back().column = metric.column;
  }
  return comparison;
}

}  // namespace sidestep::bench
