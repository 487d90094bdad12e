#include "sidestep/cli/wiring.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include "sidestep/bench/resolve.h"
#include "sidestep/bench/scenario_planner.h"
#include "sidestep/cli/sensors.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/model_name.h"
#include "sidestep/robot/variant_names.h"
#include "sidestep/scenarios/variations.h"
#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/world_model.h"
#include "sidestep/sim/simulation.h"

namespace sidestep::cli {
namespace {

void Override(scenarios::Scenario& scenario, const Overrides& overrides) {
  if (overrides.knowledge) scenario.knowledge = *overrides.knowledge;
  if (overrides.predictor) scenario.predictor = *overrides.predictor;
  if (overrides.latency) scenario.latency = scenarios::LatencyFromString(*overrides.latency);
  if (overrides.safety) scenario.safety.profile = scenarios::SafetyFromString(*overrides.safety);
  if (overrides.latency_ms) {
    if (scenario.latency == scenarios::Latency::kNone) {
      throw InputError("--latency-ms", "nothing is charged: the latency is none");
    }
    scenario.latency_s = *overrides.latency_ms / 1e3;
  }
  if (overrides.epsilon_m) {
    scenario.epsilon_m = *overrides.epsilon_m;
    if (scenario.epsilon_m > scenarios::kMaxMarginCells * scenario.grid.cell_m) {
      throw InputError("--epsilon", "must be at most " +
                                        std::to_string(scenarios::kMaxMarginCells) +
                                        " cells of the workspace");
    }
  }
  if (overrides.speed_m_s) scenarios::SetSpeed(scenario, *overrides.speed_m_s);
  if (scenario.latency_s > scenario.horizon_s) {
    throw InputError("--latency-ms", "must not exceed the horizon");
  }
}

bool IsWithin(const std::string& path, const std::string& whole) {
  return path == whole || path.starts_with(whole + ".") || path.starts_with(whole + "[");
}

// What a flag and a setting both give would depend on which of them comes last.
void CheckGivenOnce(const Overrides& overrides) {
  const struct {
    const char* flag;
    const char* key;
    bool is_given;
  } flags[] = {{"--knowledge", "knowledge", overrides.knowledge.has_value()},
               {"--predictor", "predictor", overrides.predictor.has_value()},
               {"--seed", "seed", overrides.seed.has_value()},
               {"--latency", "replanning.latency", overrides.latency.has_value()},
               {"--safety", "safety.profile", overrides.safety.has_value()},
               {"--latency-ms", "replanning.latency_s", overrides.latency_ms.has_value()},
               {"--epsilon", "planner.epsilon_m", overrides.epsilon_m.has_value()}};
  const auto fail = [](const std::string& path, const std::string& flag) {
    throw InputError("--set " + path, "is given by " + flag + " as well");
  };
  for (const auto& [path, value] : overrides.settings) {
    for (const auto& [flag, key, is_given] : flags) {
      if (is_given && (IsWithin(path, key) || IsWithin(key, path))) fail(path, flag);
    }
    const bool is_speed = IsWithin(path, "moving_obstacles") && path.ends_with(".speed_m_s");
    if (is_speed && overrides.speed_m_s) fail(path, "--speed");
  }
}

// Complains about `word` where it was written: the flag if there was one, else the file's line.
void CheckWord(const scenarios::Scenario& scenario, const std::string& key, const std::string& word,
               const std::vector<std::string>& known, const char* flag = nullptr) {
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  const std::string why = "must be one of " + Joined(known) + ", is '" + word + "'";
  if (flag != nullptr) throw InputError(flag, why);
  throw scenarios::WrongValue(scenario, key, why);
}

// The file, overridden, with the words judged that have nothing to do with a robot.
scenarios::Scenario LoadOverridden(const std::string& name, const Overrides& overrides,
                                   const DataPaths& paths) {
  CheckGivenOnce(overrides);
  scenarios::Settings settings = overrides.settings;
  if (overrides.seed) settings["seed"] = std::to_string(*overrides.seed);  // motions follow from it
  scenarios::Scenario scenario = scenarios::LoadScenario(FindScenario(name, paths), settings);
  Override(scenario, overrides);
  CheckWord(scenario, "knowledge", scenario.knowledge, KnowledgeWords(),
            overrides.knowledge ? "--knowledge" : nullptr);
  CheckWord(scenario, "predictor", scenario.predictor, sdf::PredictorNames(),
            overrides.predictor ? "--predictor" : nullptr);
  for (const scenarios::SensorSettings& sensor : scenarios::SensorsOf(scenario)) {
    CheckWord(scenario, sensor.path + ".name", sensor.name, SensorNames());
  }
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    const std::string& appearance = scenario.moving_obstacles[i].appearance;
    if (appearance.empty()) continue;
    CheckWord(scenario, "moving_obstacles[" + std::to_string(i) + "].appearance", appearance,
              paths.all_models().NamesWith("*.xml"));
  }
  return scenario;
}

// A robot that is named is one of those that are looked for; one by its path has its files there.
void CheckRobotIsThere(const scenarios::Scenario& scenario, const ModelFolders& models) {
  const std::vector<std::string> known = robot::RobotModel::ListNames(models);
  if (scenario.robot_path.empty() &&
      std::find(known.begin(), known.end(), scenario.robot) == known.end()) {
    throw scenarios::WrongValue(
        scenario, "robot.model",
        "must be one of " + Joined(known) + " (of " + Joined(models.folders()) +
            "; --models DIR adds others), or a path with a /, is '" + scenario.robot + "'");
  }
  const std::string file =
      RobotFolder(scenario, models) + "/" + DescriptionFile(scenario.robot_variant);
  std::error_code error;
  if (std::filesystem::exists(file, error)) return;
  const std::vector<std::string> variants = robot::VariantNames(RobotFolder(scenario, models));
  throw scenarios::WrongValue(scenario, "robot.model",
                              "there is no " + file +
                                  (scenario.robot_variant.empty() || variants.empty()
                                       ? ""
                                       : " (known: " + Joined(variants) + ")"));
}

Problem AddRobot(scenarios::Scenario scenario, const DataPaths& paths, CheckedRobots* robots) {
  bench::ResolvePlanner(scenario);
  const ModelFolders models = paths.all_models();
  CheckRobotIsThere(scenario, models);
  robot::RobotModel robot = robots->Get(scenario, models);
  bench::ResolveTask(scenario, robot);
  return {std::move(scenario), std::move(robot)};
}

}  // namespace

robot::RobotModel RobotOf(const scenarios::Scenario& scenario, const ModelFolders& models) {
  return robot::RobotModel::FromFolder(RobotFolder(scenario, models), scenario.robot_variant,
                                       scenario.X_WB);
}

std::vector<std::string> KnowledgeWords() {
  std::vector<std::string> words;
  for (const sdf::Knowledge knowledge : sdf::kAllKnowledge) words.push_back(ToString(knowledge));
  return words;
}

scenarios::Settings ParseSettings(const std::vector<std::string>& texts) {
  scenarios::Settings settings;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw InputError("--set", "must be KEY=VALUE, is '" + text + "'");
    }
    const std::string key = text.substr(0, equals);
    if (!settings.emplace(key, text.substr(equals + 1)).second) {
      throw InputError("--set " + key, "is given twice");
    }
  }
  for (const auto& [path, value] : settings) {
    for (const auto& [whole, other_value] : settings) {
      if (path == whole || !IsWithin(path, whole)) continue;
      throw InputError("--set " + path, "is given by --set " + whole + " as well");
    }
  }
  return settings;
}

Problem LoadProblem(const std::string& name, const Overrides& overrides, const DataPaths& paths) {
  CheckedRobots robots;
  return LoadProblem(name, overrides, paths, &robots);
}

Problem LoadProblem(const std::string& name, const Overrides& overrides, const DataPaths& paths,
                    CheckedRobots* robots) {
  scenarios::Scenario scenario = LoadOverridden(name, overrides, paths);
  if (scenario.robot.empty()) {
    throw InputError("SCENARIO", "'" + name + "' has no robot: it can be drawn (sidestep field) " +
                                     "and timed (sidestep reproduce sdf_timing), but not run");
  }
  Problem problem = AddRobot(std::move(scenario), paths, robots);
  if (overrides.safety && *overrides.safety != "off" && problem.robot.capsules().empty()) {
    throw InputError("--safety", problem.robot.name() + " has no capsules to be supervised by");
  }
  return problem;
}

Scene LoadScene(const std::string& name, const Overrides& overrides, const DataPaths& paths) {
  scenarios::Scenario scenario = LoadOverridden(name, overrides, paths);
  if (scenario.robot.empty()) {
    bench::EpisodeWorld world = bench::MakeEpisodeWorld(
        std::make_shared<sim::Simulation>(scenario, paths.all_models(), &MakeSensor));
    return {std::move(scenario), std::move(world)};
  }
  CheckedRobots robots;
  Problem problem = AddRobot(std::move(scenario), paths, &robots);
  bench::EpisodeWorld world = SimulatedWorlds(paths)(problem.scenario, problem.robot);
  return {std::move(problem.scenario), std::move(world)};
}

bench::WorldFactory SimulatedWorlds(const DataPaths& paths) {
  return [models = paths.all_models(), store = std::make_shared<sim::ModelStore>()](
             const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
    return bench::MakeEpisodeWorld(
        std::make_shared<sim::Simulation>(scenario, robot, models, &MakeSensor, store.get()));
  };
}

}  // namespace sidestep::cli
