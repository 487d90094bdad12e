#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/cli/checked_robots.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// What the command line may change of a scenario; each thing once, by a flag or by a setting.
struct Overrides {
  scenarios::Settings settings;  ///< put in place first
  std::optional<std::string> knowledge, predictor, latency, safety;
  std::optional<double> speed_m_s;  ///< of every moving obstacle
  std::optional<int> seed;
  std::optional<double> latency_ms, epsilon_m;
};

/// KEY=VALUE each. @throws InputError for one without a key or a =, or a key given twice, be it as
/// a part of another.
scenarios::Settings ParseSettings(const std::vector<std::string>& texts);

/// The kinds of knowledge there are.
std::vector<std::string> KnowledgeWords();

/// A scenario that is ready to run, and its robot.
struct Problem {
  scenarios::Scenario scenario;
  robot::RobotModel robot;
};

/// The robot of a scenario that has one. @throws InputError.
robot::RobotModel RobotOf(const scenarios::Scenario& scenario, const ModelFolders& models);

/// Reads, overrides, loads the robot and judges everything that a person wrote, every name too.
/// @throws InputError.
Problem LoadProblem(const std::string& scenario, const Overrides& overrides,
                    const DataPaths& paths);
/// The same, one of many. @param robots those of the others, to which its own is added.
Problem LoadProblem(const std::string& scenario, const Overrides& overrides, const DataPaths& paths,
                    CheckedRobots* robots);

/// A scenario's simulated world at time 0.
struct Scene {
  scenarios::Scenario scenario;
  bench::EpisodeWorld world;
};

/// The same for what needs no robot, so that the scenario may have none. @throws InputError.
Scene LoadScene(const std::string& scenario, const Overrides& overrides, const DataPaths& paths);

/// Simulated worlds. Who makes many keeps this, or copies of it: what they have in common is
/// compiled once.
bench::WorldFactory SimulatedWorlds(const DataPaths& paths);

}  // namespace sidestep::cli
