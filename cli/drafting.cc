#include "sidestep/cli/drafting.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "sidestep/cli/shell_quote.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/model_name.h"
#include "sidestep/core/utf8.h"
#include "sidestep/sim/simulation.h"
#include "sidestep/sim/static_geoms.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

// A robot's folder from the folder of a scenario on, told as a path: with a /.
std::string PathFrom(const std::string& out, const std::string& folder) {
  if (fs::path(folder).is_absolute()) return folder;
  const fs::path from = out.empty() ? fs::current_path() : fs::absolute(out).parent_path();
  std::string path =
      fs::absolute(folder).lexically_normal().lexically_relative(from.lexically_normal()).string();
  if (path.find('/') == std::string::npos) path = "./" + path;
  return path;
}

}  // namespace

Draft BeginDraft(const std::string& robot, const Pose& X_WB, const std::string& out,
                 const DataPaths& paths) {
  const ModelFolders models = paths.all_models();
  const bool is_path = robot.find('/') != std::string::npos;
  const std::string own = ModelFolder(robot), variant = ModelVariant(robot);
  const std::vector<std::string> known = robot::RobotModel::ListNames(models);
  if (!is_path && std::find(known.begin(), known.end(), own) == known.end()) {
    throw InputError("--robot", "must be one of " + Joined(known) + " (of " +
                                    Joined(models.folders()) + "), or a path with a /, is '" +
                                    robot + "'");
  }
  fs::path folder = is_path ? fs::path(own).lexically_normal() : fs::path(*models.Find(own));
  if (!folder.has_filename()) folder = folder.parent_path();
  robot::RobotModel model = robot::RobotModel::FromFolder(folder.string(), variant, X_WB);
  Draft draft = {imports::DraftScenario(model), std::move(model)};
  draft.scenario.file = out;
  draft.scenario.robot_variant = variant;
  draft.scenario.name =
      out.empty() ? draft.robot.name() : EscapeInvalidUtf8(fs::path(out).stem().string());
  if (is_path) draft.scenario.robot_path = PathFrom(out, folder.string());
  return draft;
}

double FootHeight(const Draft& draft, const DataPaths& paths) {
  scenarios::Scenario scenario = draft.scenario;
  scenario.static_obstacles.clear();
  scenario.moving_obstacles.clear();
  scenario.mount.clear();
  scenario.floor_m = -1e3;  // far below
  if (scenario.q_start.size() == 0) scenario.q_start.setZero(draft.robot.num_joints());
  const sim::Simulation simulation(scenario, draft.robot, paths.all_models());
  const double height_m = sim::FootHeight(simulation.world());
  return std::isfinite(height_m) ? height_m : -std::numeric_limits<double>::infinity();
}

imports::IsGood TouchesNothing(const Draft& draft, const DataPaths& paths) {
  return [&draft, models = paths.all_models()](const Eigen::VectorXd& q) {
    scenarios::Scenario scenario = draft.scenario;
    scenario.moving_obstacles.clear();
    scenario.q_start = q;
    sim::Simulation simulation(scenario, draft.robot, models);
    for (const TruthSample& sample : simulation.truth().TakeSamples()) {
      if (sample.in_contact || sample.clearance_m < 0) return false;
    }
    return true;
  };
}

void CheckIsNew(const std::string& out, const std::string& option) {
  if (out.empty()) return;
  std::error_code error;
  if (fs::is_regular_file(out, error)) {
    throw InputError(option, "'" + out + "' is there already; choose another name or remove it");
  }
  CheckCanWrite(out);
}

std::string HowToRun(const std::string& out, const std::vector<std::string>& models) {
  std::string command = "sidestep run " + (out.empty() ? "FILE" : ShellQuoted(out));
  for (const std::string& folder : models) command += " --models " + ShellQuoted(folder);
  return command;
}

}  // namespace sidestep::cli
