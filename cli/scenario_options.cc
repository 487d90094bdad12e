#include "sidestep/cli/scenario_options.h"

#include "sidestep/cli/number_range.h"
#include "sidestep/core/joined.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::cli {

void AddModels(CLI::App& command, std::vector<std::string>& models) {
  command
      .add_option("--models", models,
                  "A folder of robots, searched before those that come with Sidestep; may be "
                  "repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);
}

CLI::Option* AddScenario(CLI::App& command, ScenarioOptions& options) {
  command
      .add_option("--set", options.settings,
                  "KEY=VALUE: one of the scenario's choices (pair=3), or any key of its file by "
                  "its path (planner.qc=2, moving_obstacles[0].name=cart); may be repeated")
      ->allow_extra_args(false);
  AddModels(command, options.models);
  return command.add_option("SCENARIO", options.scenario, "A name (see `sidestep list`) or a path")
      ->required();
}

void AddScenarioOptions(CLI::App& command, ScenarioOptions& options,
                        const std::vector<std::string>& knowledge) {
  AddScenario(command, options);
  Overrides& overrides = options.overrides;
  command.add_option("--knowledge", overrides.knowledge,
                     "What the planner is told: " + Joined(knowledge));
  command.add_option("--predictor", overrides.predictor, "How objects are extrapolated");
  command.add_option("--speed", overrides.speed_m_s, "Speed of every moving obstacle [m/s]")
      ->check(NumberFrom(0.0, 100.0));
  command.add_option("--seed", overrides.seed, "Seed of everything random")
      ->check(NumberFrom(0, 2147483647));
}

std::vector<std::string> KnowsNoFuture() {
  std::vector<std::string> words = KnowledgeWords();
  std::erase(words, sdf::ToString(sdf::Knowledge::kFullKnowledge));
  return words;
}

Overrides ParseOverrides(const ScenarioOptions& options) {
  Overrides overrides = options.overrides;
  overrides.settings = ParseSettings(options.settings);
  return overrides;
}

}  // namespace sidestep::cli
