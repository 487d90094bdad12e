#include "sidestep/bench/report/comparison.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sidestep/bench/outcome.h"
#include "sidestep/bench/run_row.h"

namespace sidestep::bench {
namespace {

// What a pair shares: the levels of all other factors, and the seed.
std::vector<std::int64_t> LevelsBut(const RunTable& runs, std::size_t run, int factor) {
  std::vector<std::int64_t> key = {runs.seed[run]};
  for (std::size_t f = 0; f < runs.levels.size(); ++f) {
    if (static_cast<int>(f) != factor) key.push_back(runs.levels[f][run]);
  }
  return key;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> PairsOf(const RunTable& runs,
                                                         const Question& question) {
  const std::vector<int>& level = runs.levels[static_cast<std::size_t>(question.factor)];
  std::map<std::vector<std::int64_t>, std::size_t> others;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (level[run] == question.with) others.emplace(LevelsBut(runs, run, question.factor), run);
  }
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (level[run] != question.of) continue;
    const auto found = others.find(LevelsBut(runs, run, question.factor));
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
    std::vector<PairedNumber> numbers;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const double a = column->second[pairs[i].first], b = column->second[pairs[i].second];
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      if (metric.goals_only && !(outcomes[i].first && outcomes[i].second)) continue;
      numbers.push_back({outcomes[i].cluster, a, b});
    }
    if (numbers.empty()) continue;
    comparison.metrics.push_back({ComparePairedMedians(numbers), metric.column});
  }
  return comparison;
}

}  // namespace sidestep::bench
