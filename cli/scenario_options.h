#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "sidestep/cli/wiring.h"

namespace sidestep::cli {

/// A scenario as a command line names and changes it: the same flags for every command that looks
/// into one.
struct ScenarioOptions {
  std::string scenario;
  Overrides overrides;                ///< but for its settings
  std::vector<std::string> settings;  ///< KEY=VALUE
  std::vector<std::string> models;    ///< further folders of robots
};

/// Adds --models, for every command that loads robots.
void AddModels(CLI::App& command, std::vector<std::string>& models);

/// Adds SCENARIO, --set and --models, for who wants to know where things are. @return SCENARIO.
CLI::Option* AddScenario(CLI::App& command, ScenarioOptions& options);

/// The same, and --knowledge, --predictor, --speed and --seed.
/// @param knowledge the words that it may be.
void AddScenarioOptions(CLI::App& command, ScenarioOptions& options,
                        const std::vector<std::string>& knowledge = KnowledgeWords());

/// The kinds of knowledge where nobody can know the future.
std::vector<std::string> KnowsNoFuture();

/// All that was asked for. @throws InputError for a setting that is none.
Overrides ParseOverrides(const ScenarioOptions& options);

}  // namespace sidestep::cli
