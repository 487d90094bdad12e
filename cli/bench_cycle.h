#pragma once

#include <string>
#include <vector>

#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/scenario_options.h"

namespace sidestep::cli {

struct CycleBenchOptions {
  ScenarioOptions scenario;
  std::vector<std::string> planners;  ///< empty: the scenario's
  int num_runs = 5;
  std::string json;
};

/// `sidestep bench cycle`: runs a scenario under each planner in turn, again and again, and prints
/// the CPU time of each stage of its planning cycles. @return the exit code.
int BenchCycles(const CycleBenchOptions& options);

}  // namespace sidestep::cli
