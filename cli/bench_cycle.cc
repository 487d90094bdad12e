#include "sidestep/cli/bench_cycle.h"

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/json_text.h"
#include "sidestep/bench/outcome.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/option_lists.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/planner/registry.h"

namespace sidestep::cli {
namespace {

// One planner with the scenario. Runs are equal but for their times, of which the least counts.
struct Bench {
  std::string planner;
  Problem problem;
  std::string outcome = "";
  bench::StageTimes least_s = {};

  void Run(const DataPaths& paths) {
    const bench::EpisodeResult result =
        bench::RunEpisode(problem.scenario, problem.robot, SimulatedWorlds(paths));
    bench::RequireWhole(result);
    outcome = ToString(result.outcome);
    for (const auto& [stage, times_s] : result.times) {
      std::vector<double>& least = least_s[stage];
      least.resize(times_s.size(), std::numeric_limits<double>::infinity());
      for (std::size_t i = 0; i < times_s.size(); ++i) least[i] = std::min(least[i], times_s[i]);
    }
  }
};

struct Row {
  std::string planner, stage;
  std::size_t cycles = 0;
  double first_ms = 0, median_ms = 0, p95_ms = 0, p99_ms = 0;  ///< NaN without a cycle
};

Row RowOf(const Bench& bench, const std::string& stage) {
  const std::vector<double>& times_s = bench.least_s.at(stage);
  const auto quantile_ms = [&](double share) { return 1e3 * bench::Quantile(times_s, share); };
  const double first_s =
      times_s.empty() ? std::numeric_limits<double>::quiet_NaN() : times_s.front();
  return {
      bench.planner,    stage, times_s.size(), 1e3 * first_s, quantile_ms(0.5), quantile_ms(0.95),
      quantile_ms(0.99)};
}

void PrintRow(const Row& row) {
  const auto text = [](double ms) { return FiniteText("{:.3f}", ms); };
  Print("{:<14} {:<9} {:>6} {:>9} {:>9} {:>9} {:>9}\n", row.planner, row.stage, row.cycles,
        text(row.first_ms), text(row.median_ms), text(row.p95_ms), text(row.p99_ms));
}

nlohmann::ordered_json JsonOf(const Row& row) {
  return {{"planner", row.planner},   {"stage", row.stage},         {"cycles", row.cycles},
          {"first_ms", row.first_ms}, {"median_ms", row.median_ms}, {"p95_ms", row.p95_ms},
          {"p99_ms", row.p99_ms}};
}

std::vector<Bench> MakeBenches(const CycleBenchOptions& options, const DataPaths& paths) {
  CheckWords("--planners", options.planners, planner::PlannerNames());
  std::vector<std::string> names = options.planners;
  if (names.empty()) names.emplace_back();
  std::vector<Bench> benches;
  for (const std::string& name : names) {
    Overrides overrides = ParseOverrides(options.scenario);
    if (!name.empty() && !overrides.settings.emplace("planner.name", name).second) {
      throw InputError("--set planner.name", "is given by --planners as well");
    }
    Problem problem = LoadProblem(options.scenario.scenario, overrides, paths);
    if (problem.scenario.latency == scenarios::Latency::kMeasured) {
      throw WrongValue(problem.scenario, "replanning.latency",
                       "is measured: no two runs have the same cycles to time");
    }
    const std::string planner = problem.scenario.planner;
    benches.push_back({.planner = planner, .problem = std::move(problem)});
  }
  return benches;
}

}  // namespace

int BenchCycles(const CycleBenchOptions& options) {
  if (!options.json.empty()) CheckCanWrite(options.json);
  const DataPaths paths = FindDataPaths(options.scenario.models);
  std::vector<Bench> benches = MakeBenches(options, paths);
  for (int run = 0; run < options.num_runs; ++run) {
    for (Bench& bench : benches) bench.Run(paths);
  }

  nlohmann::ordered_json json = {{"scenario", benches.front().problem.scenario.name},
                                 {"runs", options.num_runs}};
  json["rows"] = nlohmann::ordered_json::array();
  Print("{:<14} {:<9} {:>6} {:>9} {:>9} {:>9} {:>9}\n", "planner", "stage", "cycles", "first ms",
        "median", "p95", "p99");
  for (const Bench& bench : benches) {
    const auto tell = [&](const Row& row) {
      PrintRow(row);
      json["rows"].push_back(JsonOf(row));
    };
    for (const char* const stage : bench::kCycleStages) tell(RowOf(bench, stage));
    tell(RowOf(bench, "cycle"));
  }
  for (const Bench& bench : benches) Print("{:<14} {}\n", bench.planner, bench.outcome);
  if (!options.json.empty()) WriteFile(options.json, bench::JsonText(json));
  return 0;
}

}  // namespace sidestep::cli
