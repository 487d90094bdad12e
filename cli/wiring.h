#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/episode.h"
#include "cli/data_paths.h"
#include "robot/robot_model.h"
#include "scenarios/scenario.h"

namespace sidestep {

/// What the command line may change of a scenario.
struct Overrides {
  Settings settings;  ///< put in place first
  std::optional<std::string> knowledge, predictor;
  std::optional<double> speed_m_s;  ///< of every moving obstacle
  std::optional<int> seed;
  std::optional<double> latency_ms, epsilon_m;
};

/// KEY=VALUE each. @throws InputError for one without a key or a =, or a key given twice.
Settings ParseSettings(const std::vector<std::string>& texts);

/// A scenario that is ready to run, and its robot.
struct Problem {
  Scenario scenario;
  RobotModel robot;
};

/// Reads, overrides, loads the robot and judges everything that a person wrote, every name too.
/// @throws InputError.
Problem LoadProblem(const std::string& scenario, const Overrides& overrides,
                    const DataPaths& paths);

/// A scenario's simulated world at time 0.
struct Scene {
  Scenario scenario;
  EpisodeWorld world;
};

/// The same for what needs no robot, so that the scenario may have none. @throws InputError.
Scene LoadScene(const std::string& scenario, const Overrides& overrides, const DataPaths& paths);

/// Simulated worlds.
WorldFactory SimulatedWorlds(const DataPaths& paths);

}  // namespace sidestep
