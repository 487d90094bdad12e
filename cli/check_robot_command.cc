#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/drafting.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/robot_check.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/import/sphere_cover.h"
#include "sidestep/import/variant_text.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/robot_picture.h"
#include "sidestep/render/video_writer.h"
#include "sidestep/sim/robot_configuration.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

struct CheckRobotOptions {
  std::string robot, cover_file, json, out, command;
  std::vector<std::string> models;
  std::optional<double> cover_mm;
  int spheres = 0;  // 0: not given
  double most_excess_percent = 35;
  int configurations = 10000;
  std::uint64_t seed = 1;
};

constexpr const char* kPicture = "spheres.png";
constexpr int kPictureSize = 700;

// Two links that were seen to touch are kept apart, unless their spheres overlap so often where
// they do not touch that hardly a plan would be left; and so are those that the robot names.
std::vector<std::pair<std::string, std::string>> PairsToKeepApart(
    const CheckedRobot& checked, const sim::SelfContactSurvey& survey) {
  constexpr double kMostFalseAlarms = 0.1;  // of all configurations
  const robot::RobotModel& robot = checked.robot;
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const sim::PairCount& pair : survey.pairs) {
    const bool is_listed = std::any_of(
        robot.self_collision().begin(), robot.self_collision().end(), [&](const auto& listed) {
          return listed.first == pair.first && listed.second == pair.second;
        });
    const bool is_useful =
        pair.touched > 0 && pair.false_alarms <= kMostFalseAlarms * survey.num_configurations;
    if (!is_listed && !is_useful) continue;
    pairs.emplace_back(sim::LinkName(robot, pair.first), sim::LinkName(robot, pair.second));
  }
  return pairs;
}

bool IsOfMount(const robot::RobotModel& robot, const sim::RigidLink& link) {
  const auto is_mount = [&robot](const std::string& body) {
    const auto& mount = robot.mount_links();
    return std::find(mount.begin(), mount.end(), body) != mount.end();
  };
  return std::any_of(link.shape_body.begin(), link.shape_body.end(), is_mount) ||
         std::any_of(link.hull_body.begin(), link.hull_body.end(), is_mount);
}

// Covers the robot's solids anew and writes the spheres as a variant of it.
void WriteCover(const CheckRobotOptions& options, const CheckedRobot& checked) {
  imports::CoverRequest request;
  request.cover_m = options.cover_mm.value_or(0) / 1e3;
  request.num_spheres = options.spheres;
  request.max_excess = options.most_excess_percent / 100;
  std::vector<sim::RigidLink> links = sim::FindRigidLinks(checked.robot, *checked.model);
  std::erase_if(links, [](const sim::RigidLink& link) { return !link.has_solids(); });
  if (options.spheres > 0 && options.spheres < static_cast<int>(links.size())) {
    throw InputError("--spheres",
                     fmt::format("must be at least one a link with solids: {}", links.size()));
  }
  std::vector<imports::LinkSolids> solids;
  for (const sim::RigidLink& link : links) solids.push_back(SolidsToCover(link));
  Print("looking for collision spheres\n");  // it may take a minute
  const imports::RobotCover cover = imports::CoverLinks(solids, request);

  imports::Variant variant;
  variant.comment = {
      fmt::format("{} spheres that cover the solids of {}: no point of them is more than {:.3g} mm",
                  cover.num_spheres(), fs::path(checked.mjcf).filename().string(),
                  1e3 * cover.cover_m),
      fmt::format("outside of all spheres of its link, whose volume is {:.1f} % {} than theirs.",
                  100 * std::abs(cover.excess()), cover.excess() < 0 ? "less" : "more"),
      "Keys, units and conventions: docs/robots.md. Made by:", "  " + options.command};
  std::error_code error;
  const fs::path folder = fs::absolute(options.cover_file).parent_path();
  const fs::path robot_file = fs::absolute(checked.robot.file());
  variant.extends = fs::relative(robot_file, folder, error).generic_string();
  if (error || variant.extends.empty()) variant.extends = robot_file.generic_string();
  for (std::size_t i = 0; i < links.size(); ++i) {
    variant.links.push_back({sim::LinkName(checked.robot, links[i].link), cover.links[i].spheres,
                             IsOfMount(checked.robot, links[i])});
  }
  // Which pairs are worth while is told with the spheres in place.
  variant.self_collision.emplace();
  WriteFile(options.cover_file, imports::VariantText(variant));
  const robot::RobotModel covered = robot::RobotModel::FromFile(options.cover_file, Pose());
  variant.self_collision = PairsToKeepApart(
      checked,
      sim::SurveySelfContacts(covered, *checked.model, options.configurations, options.seed));
  WriteFile(options.cover_file, imports::VariantText(variant));
  Print("written          {}: {} spheres, at most {:.3g} mm left out\n\n", options.cover_file,
        cover.num_spheres(), 1e3 * cover.cover_m);
}

void DrawInto(const std::string& path, const CheckedRobot& checked) {
  const robot::RobotModel& robot = checked.robot;
  const render::GlContext gl;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.num_joints());
  if (robot.configurations().count("home") > 0) {
    q = robot.configurations().at("home");
  } else if (!robot.configurations().empty()) {
    q = robot.configurations().begin()->second;
  }
  render::WritePng(render::DrawRobotAndSpheres(gl, robot, *checked.model, q, kPictureSize), path);
}

int CheckRobot(const CheckRobotOptions& options) {
  if (options.cover_file.empty() && options.spheres > 0) {
    throw InputError("--spheres", "is for --write-cover");
  }
  if (!options.cover_file.empty() && !options.cover_mm && options.spheres == 0) {
    throw InputError("--write-cover", "needs --cover-mm, --spheres, or both");
  }
  if (!options.cover_file.empty() && options.cover_mm && !(*options.cover_mm > 0)) {
    throw InputError("--cover-mm", "must be > 0 to cover the robot anew");
  }
  CheckIsNew(options.cover_file, "--write-cover");
  const DataPaths paths = FindDataPaths(options.models);
  CheckedRobot checked = LoadRobot(options.robot, paths.all_models());
  std::optional<OutFolder> out;
  if (!options.out.empty()) out.emplace(options.out, std::vector<std::string>{kPicture});
  if (!options.json.empty()) CheckCanWrite(options.json);
  if (!options.cover_file.empty()) {
    WriteCover(options, checked);
    checked.robot = robot::RobotModel::FromFile(options.cover_file, Pose());
    checked.file = options.cover_file;
  }
  const RobotReport report = ReportOn(checked, options.configurations, options.seed);
  PrintText(ReportText(checked, report));
  if (!options.json.empty()) WriteFile(options.json, ReportJson(checked, report));
  if (out) {
    DrawInto(out->path() + "/" + kPicture, checked);
    Print("written          {}/{}\n", out->path(), kPicture);
  }
  const bool sticks_out = options.cover_mm && report.uncovered_m > *options.cover_mm / 1e3;
  if (sticks_out) PrintError("check-robot: more than {} mm sticks out\n", *options.cover_mm);
  return sticks_out ? 1 : 0;
}

}  // namespace

void AddCheckRobotCommand(CommandLine& line) {
  auto options = std::make_shared<CheckRobotOptions>();
  CLI::App* const check = line.app.add_subcommand(
      "check-robot",
      "Say how well a robot's spheres cover it, and whether its two files agree; or cover it anew");
  check
      ->add_option("ROBOT", options->robot,
                   "A robot or a variant (panda, panda:covered); or a path to a folder, robot.yaml "
                   "or variant")
      ->required();
  check
      ->add_option("--cover-mm", options->cover_mm,
                   "Exit with 1 if solids stick out of the spheres by more than that [mm]; with "
                   "--write-cover, what the new ones may leave out")
      ->check(NumberFrom(0, 1e6));
  AddModels(*check, options->models);
  check->add_option("--json", options->json, "The report as a file of JSON");
  check->add_option("--out", options->out,
                    "A folder for spheres.png, the solids and the spheres from four sides");
  check->add_option("--write-cover", options->cover_file,
                    "Cover the solids with new spheres, and write them as a variant, FILE.yaml");
  check
      ->add_option("--spheres", options->spheres,
                   "With --write-cover: so many new spheres at most; without --cover-mm they leave "
                   "out as little as they can, with it their volume is the least")
      ->check(NumberFrom(1, 10000));
  check
      ->add_option("--most-excess", options->most_excess_percent,
                   "With --write-cover: by how much the spheres' volume may exceed that of the "
                   "solids [35 %]")
      ->check(NumberFrom(0, 1e6));
  check
      ->add_option("--configurations", options->configurations,
                   "Random ones that are searched for self-contact [10000]")
      ->check(NumberFrom(1, 1e8));
  check->add_option("--seed", options->seed, "Of the random configurations [1]")
      ->check(NumberFrom(0, 2147483647));
  check->callback([&line, options] {
    options->command = line.text;
    line.exit_code = CheckRobot(*options);
  });
}

}  // namespace sidestep::cli
