#include <fmt/core.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/resolve.h"
#include "sidestep/bench/scenario_planner.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/drafting.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/import/commented_yaml.h"

namespace sidestep::cli {
namespace {

struct NewScenarioOptions {
  std::string robot, out;
  int seed = 1;
  std::vector<std::string> models;
  std::string command;  // as it was typed
};

int NewScenario(const NewScenarioOptions& options) {
  const DataPaths paths = FindDataPaths(options.models);
  CheckIsNew(options.out);
  Draft draft = BeginDraft(options.robot, Pose(), options.out, paths);
  scenarios::Scenario& scenario = draft.scenario;
  scenario.description = "A " + scenario.robot + " moves while a ball flies through its way";
  scenario.seed = static_cast<std::uint64_t>(options.seed);
  const double foot_m = FootHeight(draft, paths);
  scenario.floor_m =
      std::isfinite(foot_m) ? std::round(1e4 * foot_m) / 1e4 : scenario.grid.first_center_m.z();
  RandomStream random(scenario.seed, "task");
  if (!imports::ChooseTask(scenario, draft.robot, random, TouchesNothing(draft, paths))) {
    throw InputError("--robot", "no start and goal were found at which '" + options.robot +
                                    "' touches nothing; try another --seed");
  }
  imports::FitHorizon(scenario, draft.robot);
  imports::AddCrossingBall(scenario, draft.robot);
  scenarios::Scenario judged = scenario;  // as `sidestep run` will
  bench::ResolvePlanner(judged);
  bench::ResolveTask(judged, draft.robot);

  const std::string text = imports::CommentedYaml(
      scenario, {"Made by `" + options.command + "`. It runs as it is:", "",
                 "    " + HowToRun(options.out, options.models), "",
                 "Change what you like; docs/scenario.md has every key. The robot's named",
                 "configurations stand in its robot.yaml."});
  if (options.out.empty()) {
    PrintText(text);
    return 0;
  }
  WriteFile(options.out, text);
  Print("written {}\n", options.out);
  return 0;
}

}  // namespace

void AddNewScenarioCommand(CommandLine& line) {
  auto options = std::make_shared<NewScenarioOptions>();
  CLI::App* const command =
      line.app.add_subcommand("new-scenario",
                              "Write a commented scenario for a robot, to begin with: start and "
                              "goal found free, and a ball "
                              "that flies through the way");
  command->add_option("--robot", options->robot, "One of `sidestep list robots`, or its folder")
      ->required();
  command->add_option("--out", options->out, "FILE.yaml to write, a new one [standard output]");
  command->add_option("--seed", options->seed, "For another start, goal and ball [1]")
      ->check(NumberFrom(0, 2147483647));
  AddModels(*command, options->models);
  command->callback([&line, options] {
    options->command = line.text;
    line.exit_code = NewScenario(*options);
  });
}

}  // namespace sidestep::cli
