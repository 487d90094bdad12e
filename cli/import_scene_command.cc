#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
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
#include "sidestep/core/utf8.h"
#include "sidestep/import/commented_yaml.h"
#include "sidestep/import/free_space.h"
#include "sidestep/import/moveit_files.h"
#include "sidestep/import/scene_into_scenario.h"
#include "sidestep/sim/static_geoms.h"

namespace sidestep::cli {
namespace {

struct ImportOptions {
  std::string file, request, robot, out;
  std::vector<double> base;  // x, y, z [m] and yaw [rad]
  int seed = 1;
  std::vector<std::string> leave_out, models;
  std::string command;  // as it was typed
};

imports::ImportedScene ReadMjcfScene(const std::string& path) {
  sim::StaticGeoms geoms = sim::ReadStaticGeoms(path);
  imports::ImportedScene scene;
  scene.floor_m = geoms.floor_m;
  scene.left_out = std::move(geoms.left_out);
  std::vector<std::string> taken = {"floor", "self", "world"};
  for (sim::StaticGeom& geom : geoms.solids) {
    if (std::holds_alternative<ConvexMesh>(geom.placed.shape)) {
      scene.changed.push_back("'" + geom.name + "': the convex hull of its mesh");
    }
    scene.obstacles.push_back(
        {imports::FreeName(geom.name, taken), geom.placed.X_WO, std::move(geom.placed.shape)});
  }
  return scene;
}

// Where a request has what becomes the task.
std::map<std::string, int> LinesOf(const imports::ImportedRequest& request) {
  std::map<std::string, int> lines;
  if (request.start) lines["task.start"] = request.start->line;
  if (request.goal) lines["task.goal"] = request.goal->line;
  if (request.goal_pose) lines["task.goal"] = request.goal_pose->line;
  return lines;
}

// Takes things out by their names in the scenario, such as what the hand is to hold at the goal.
void LeaveOut(const std::vector<std::string>& names, imports::ImportedScene& scene) {
  for (const std::string& name : names) {
    const auto is_it = [&](const scenarios::StaticObstacle& thing) { return thing.name == name; };
    if (std::erase_if(scene.obstacles, is_it) == 0) {
      throw InputError("--leave-out", "the scene has no '" + name + "'");
    }
    scene.left_out.push_back("'" + name + "', as asked for");
  }
}

Pose BaseOf(const ImportOptions& options) {
  if (options.base.empty()) return Pose();
  for (const double number : options.base) {
    if (!(std::abs(number) <= 1e6)) throw InputError("--base", "must be numbers within 1000 km");
  }
  const double yaw = options.base.size() > 3 ? options.base[3] : 0;
  return Pose::FromRollPitchYaw({0, 0, yaw}, {options.base[0], options.base[1], options.base[2]});
}

int ImportScene(const ImportOptions& options) {
  const DataPaths paths = FindDataPaths(options.models);
  CheckIsNew(options.out);
  Draft draft = BeginDraft(options.robot, BaseOf(options), options.out, paths);
  scenarios::Scenario& scenario = draft.scenario;
  const bool is_mjcf = std::filesystem::path(options.file).extension() == ".xml";
  imports::ImportedScene scene =
      is_mjcf ? ReadMjcfScene(options.file) : imports::ReadMoveItScene(options.file);
  LeaveOut(options.leave_out, scene);
  scenario.description =
      "Imported from " + EscapeInvalidUtf8(std::filesystem::path(options.file).filename().string());
  scenario.seed = static_cast<std::uint64_t>(options.seed);
  imports::PutInto(scene, draft.robot, scenario);
  RandomStream random(scenario.seed, "task");
  std::map<std::string, int> lines;
  if (options.request.empty()) {
    if (!imports::ChooseTask(scenario, draft.robot, random, TouchesNothing(draft, paths))) {
      throw InputError(options.file, "no start and goal were found at which '" + options.robot +
                                         "' touches nothing there; try another --seed or --base");
    }
  } else {
    const imports::ImportedRequest request = imports::ReadMoveItRequest(options.request);
    for (const std::string& line : imports::PutInto(request, draft.robot, random, scenario)) {
      scene.left_out.push_back(line);
    }
    lines = LinesOf(request);
  }
  imports::FitHorizon(scenario, draft.robot);
  scenarios::Scenario judged = scenario;  // as `sidestep run` will, with complaints of the request
  judged.file = options.request.empty() ? options.file : options.request;
  judged.lines = std::move(lines);
  bench::ResolvePlanner(judged);
  bench::ResolveTask(judged, draft.robot);

  std::vector<std::string> head = {"Made by `" + options.command + "`. To run it:", "",
                                   "    " + HowToRun(options.out, options.models)};
  for (const std::string& line : scene.changed) {
    head.push_back("Changed: " + OneLine(line));
    PrintError("changed: {}\n", OneLine(line));
  }
  for (const std::string& line : scene.left_out) {
    head.push_back("Left out: " + OneLine(line));
    PrintError("left out: {}\n", OneLine(line));
  }
  WriteFile(options.out, imports::CommentedYaml(scenario, head));
  Print("written {}: {} things\n", options.out, scenario.static_obstacles.size());
  return 0;
}

}  // namespace

void AddImportSceneCommand(CommandLine& line) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* const command = line.app.add_subcommand(
      "import-scene",
      "Make a scenario of a planning scene of MoveIt or MotionBenchMaker (YAML), or of what stands "
      "still in an MJCF world");
  command->add_option("FILE", options->file, "The scene: FILE.yaml, or FILE.xml of MuJoCo")
      ->required();
  command->add_option("--request", options->request,
                      "The motion plan request (YAML) that has start and goal, as joints or as a "
                      "pose [found free]");
  command->add_option("--robot", options->robot, "One of `sidestep list robots`, or its folder")
      ->required();
  command
      ->add_option(
          "--base", options->base,
          "Where the robot's base stands in the scene: X,Y,Z [m], and a turn about z [rad] "
          "[0,0,0,0]")
      ->delimiter(',')
      ->expected(3, 4);
  command
      ->add_option("--leave-out", options->leave_out,
                   "A thing to leave out, such as what the hand holds at the goal; may be repeated")
      ->type_name("NAME")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "FILE.yaml to write, a new one")->required();
  command
      ->add_option("--seed", options->seed,
                   "For other solutions of a pose, another start, goal [1]")
      ->check(NumberFrom(0, 2147483647));
  AddModels(*command, options->models);
  command->footer(
      "What was changed (the hull of a mesh) or left out is told on standard error, a line each, "
      "and "
      "in the file.");
  command->callback([&line, options] {
    options->command = line.text;
    line.exit_code = ImportScene(*options);
  });
}

}  // namespace sidestep::cli
