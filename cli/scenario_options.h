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
};

/// Adds SCENARIO, --set, --knowledge, --predictor, --speed and --seed.
void AddScenarioOptions(CLI::App& command, ScenarioOptions& options);

/// All that was asked for. @throws InputError for a setting that is none.
Overrides ParseOverrides(const ScenarioOptions& options);

}  // namespace sidestep::cli
