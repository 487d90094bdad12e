#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sidestep/bench/json_text.h"
#include "sidestep/bench/planner_bench/planner_bench.h"
#include "sidestep/bench/planner_bench/planner_problems.h"
#include "sidestep/cli/bench_cycle.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/option_lists.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/planner/gp_planner.h"
#include "sidestep/planner/registry.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {
namespace {

// The yardstick that only a benchmark has a use for.
constexpr const char* kPlainCeres = "gpmp_plain";

struct PlannerBenchOptions {
  std::vector<std::string> problems = bench::PlannerProblemNames();
  std::vector<std::string> planners = {kPlainCeres, "gpmp", "gpmp_ceres", "gpmp_fast"};
  int num_pairs = 100, num_runs = 3;
  int seed = 1;
  std::string json;
};

bench::NamedPlanner Named(const std::string& name) {
  if (name == kPlainCeres) {
    return {name, [](const robot::RobotModel& robot, const planner::PlannerSettings& settings,
                     const planner::Parameters& parameters) {
              return std::make_unique<planner::GpPlanner>(robot, settings,
                                                          planner::GpParameters().Read(parameters),
                                                          planner::GpPlanner::Residuals::kPlain);
            }};
  }
  return {name, [name](const robot::RobotModel& robot, const planner::PlannerSettings& settings,
                       const planner::Parameters& parameters) {
            return planner::MakePlannerLeavingOut(name, robot, settings, parameters);
          }};
}

void PrintRow(const bench::PlannerBenchRow& row) {
  Print("{:<20} {:<16} {:<14} {:>5} {:>10.3f} {:>10.3f} {:>5.0f} {:>11.4f} {:>9.1f} {:>5} {:>6}\n",
        row.problem, ToString(row.start), row.planner, row.num_tasks, row.cpu_median_ms,
        row.cpu_p95_ms, row.iterations_median, row.cost_median, 1e3 * row.clearance_median_m,
        row.num_free, row.num_within_limits);
}

nlohmann::ordered_json JsonOf(const bench::PlannerBenchRow& row) {
  return {{"problem", row.problem},
          {"start", ToString(row.start)},
          {"planner", row.planner},
          {"tasks", row.num_tasks},
          {"cpu_median_ms", row.cpu_median_ms},
          {"cpu_p95_ms", row.cpu_p95_ms},
          {"iterations_median", row.iterations_median},
          {"cost_median", row.cost_median},
          {"clearance_median_m", row.clearance_median_m},
          {"free", row.num_free},
          {"within_limits", row.num_within_limits}};
}

int BenchPlanners(const PlannerBenchOptions& options) {
  CheckWords("--problems", options.problems, bench::PlannerProblemNames());
  std::vector<std::string> known = planner::PlannerNames();
  known.emplace_back(kPlainCeres);
  CheckWords("--planners", options.planners, known);
  if (!options.json.empty()) CheckCanWrite(options.json);
  std::vector<bench::NamedPlanner> planners;
  for (const std::string& name : options.planners) planners.push_back(Named(name));

  const DataPaths paths = FindDataPaths();
  nlohmann::ordered_json json = {{"seed", options.seed}, {"runs", options.num_runs}};
  json["rows"] = nlohmann::ordered_json::array();
  Print("{:<20} {:<16} {:<14} {:>5} {:>10} {:>10} {:>5} {:>11} {:>9} {:>5} {:>6}\n", "problem",
        "start", "planner", "tasks", "CPU ms", "p95", "iter", "cost", "clear mm", "free", "limits");
  for (const std::string& name : options.problems) {
    const bench::PlannerProblem problem =
        bench::MakePlannerProblem(name, paths.models, paths.scenarios,
                                  static_cast<std::uint64_t>(options.seed), options.num_pairs);
    for (const bench::PlannerBenchRow& row :
         bench::RunPlannerBench(problem, planners, options.num_runs)) {
      PrintRow(row);
      json["rows"].push_back(JsonOf(row));
    }
  }
  if (!options.json.empty()) WriteFile(options.json, bench::JsonText(json));
  return 0;
}

struct PairsOptions {
  std::string problem, out;
  int num_pairs = 100, seed = 1;
};

int WritePairs(const PairsOptions& options) {
  CheckWords("PROBLEM", {options.problem}, bench::HitPairNames());
  CheckCanWrite(options.out);
  const DataPaths paths = FindDataPaths();
  bench::HitPairs pairs =
      bench::MakeHitPairs(options.problem, paths.models, paths.scenarios,
                          static_cast<std::uint64_t>(options.seed), options.num_pairs);
  pairs.scene.name = options.problem;
  pairs.scene.description = "Pairs of start and goal whose direct motion is hit, seed " +
                            std::to_string(options.seed) + " of " + options.problem;
  WriteFile(options.out, scenarios::ToYaml(pairs.scene, "pair", pairs.tasks));
  Print("written {}\n", options.out);
  return 0;
}

void AddPairs(CommandLine& line, CLI::App& bench) {
  auto options = std::make_shared<PairsOptions>();
  CLI::App* const pairs = bench.add_subcommand(
      "pairs", "Write the pairs of start and goal of a problem as a scenario with a choice, pair");
  pairs->add_option("PROBLEM", options->problem, Joined(bench::HitPairNames()))->required();
  pairs->add_option("--pairs", options->num_pairs, "How many")
      ->check(NumberFrom(1, 1000))
      ->capture_default_str();
  pairs->add_option("--seed", options->seed, "What they are drawn from")
      ->check(NumberFrom(0, 2147483647))
      ->capture_default_str();
  pairs->add_option("--out", options->out, "The file to write [PROBLEM.yaml]");
  pairs->footer(
      "They are those of `sidestep bench planner`: the direct motion is hit by what moves, and by\n"
      "nothing else. `sidestep study FILE` runs them all in closed loop, `sidestep run FILE --set\n"
      "pair=7` one of them.");
  pairs->callback([&line, options] {
    if (options->out.empty()) options->out = options->problem + ".yaml";
    line.exit_code = WritePairs(*options);
  });
}

void AddPlannerBench(CommandLine& line, CLI::App& bench) {
  auto options = std::make_shared<PlannerBenchOptions>();
  CLI::App* const planner =
      bench.add_subcommand("planner", "CPU time and quality of plans, cold and warm");
  planner
      ->add_option("--problems", options->problems,
                   "Comma-separated: " + Joined(bench::PlannerProblemNames()) + " [all]")
      ->delimiter(',');
  planner
      ->add_option("--planners", options->planners,
                   "Comma-separated; gpmp_plain is gpmp with a residual a sphere "
                   "[gpmp_plain,gpmp,gpmp_ceres,gpmp_fast]")
      ->delimiter(',');
  planner->add_option("--pairs", options->num_pairs, "Tasks of a problem that has many")
      ->check(NumberFrom(1, 100000))
      ->capture_default_str();
  planner->add_option("--runs", options->num_runs, "How often each is timed: the least counts")
      ->check(NumberFrom(1, 1000))
      ->capture_default_str();
  planner->add_option("--seed", options->seed, "Of the pairs of start and goal")
      ->check(NumberFrom(0, 2147483647))
      ->capture_default_str();
  planner->add_option("--json", options->json, "A file for the table as JSON");
  planner->footer(
      "One thread; the planners take turns on each task. Problems gpmp2_reference_n1 and _n19 are\n"
      "one task each, published with GPMP2 and planned without limits; the others are pairs of\n"
      "start and goal whose direct motion is hit by what moves, drawn from the seed.\n"
      "cold: from nothing. warm: 3 states fixed, from the plan that runs, whose cold plan was "
      "free;\n"
      "nothing has changed, or the obstacle is 2 cm further along than it was thought to be.\n"
      "CPU ms and p95 are the median and the 95th percentile over the tasks; free counts plans "
      "that\n"
      "touch nothing truly there, limits those of them within the robot's limits.");
  planner->callback([&line, options] { line.exit_code = BenchPlanners(*options); });
}

void AddCycleBench(CommandLine& line, CLI::App& bench) {
  auto options = std::make_shared<CycleBenchOptions>();
  CLI::App* const cycle =
      bench.add_subcommand("cycle", "CPU time of the stages of a scenario's planning cycles");
  AddScenarioOptions(*cycle, options->scenario);
  cycle
      ->add_option("--planners", options->planners,
                   "Comma-separated: those to set side by side [the scenario's]")
      ->delimiter(',');
  cycle->add_option("--runs", options->num_runs, "How often each cycle is timed: the least counts")
      ->check(NumberFrom(1, 1000))
      ->capture_default_str();
  cycle->add_option("--json", options->json, "A file for the table as JSON");
  cycle->footer(
      "Runs the scenario in simulation, the planners in turn. From reading the sensor to the "
      "plan:\n"
      "sense, map (the distance field of what is known), segment, track, predict, optimise; cycle "
      "is\n"
      "their sum. Quantiles are over the cycles of an episode; the first one plans from nothing.");
  cycle->callback([&line, options] { line.exit_code = BenchCycles(*options); });
}

}  // namespace

void AddBenchCommand(CommandLine& line) {
  CLI::App* const bench =
      line.app.add_subcommand("bench", "Time planners beside each other, or write their tasks");
  // Not required of CLI11, whose complaint would not name the word that was wrong.
  bench->require_subcommand(0, 1);
  bench->callback([bench] {
    if (!bench->get_subcommands().empty()) return;
    const auto name = [](const CLI::App* what) { return what->get_name(); };
    throw InputError("bench", "needs one of " + Joined(bench->get_subcommands({}), ", ", name));
  });
  AddPlannerBench(line, *bench);
  AddPairs(line, *bench);
  AddCycleBench(line, *bench);
}

}  // namespace sidestep::cli
