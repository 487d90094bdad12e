#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/import_robot.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {
namespace {

// JOINT=VALUE each.
std::map<std::string, double> ParseFixed(const std::vector<std::string>& texts) {
  std::map<std::string, double> fixed;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const std::string number = equals == std::string::npos ? "" : text.substr(equals + 1);
    char* end = nullptr;
    const double value = std::strtod(number.c_str(), &end);
    if (number.empty() || equals == 0 || *end != '\0' || !std::isfinite(value)) {
      throw InputError("--fix", "must be JOINT=VALUE, is '" + text + "'");
    }
    if (!fixed.emplace(text.substr(0, equals), value).second) {
      throw InputError("--fix", "'" + text.substr(0, equals) + "' is given twice");
    }
  }
  return fixed;
}

struct Options {
  RobotImport import;
  std::vector<std::string> fix;
  bool keep_up_axis = false;
  double cover_mm = 5;
};

int Import(Options options) {
  options.import.choices.fix = ParseFixed(options.fix);
  options.import.choices.turn_up_axis = !options.keep_up_axis;
  if (options.import.spheres.num_spheres == 0) {
    options.import.spheres.cover_m = options.cover_mm / 1000;
  }
  ImportRobot(options.import);
  return 0;
}

}  // namespace

void AddImportCommand(CommandLine& line) {
  auto options = std::make_shared<Options>();
  RobotImport& import = options->import;
  CLI::App* const command = line.app.add_subcommand(
      "import", "Make a robot of a URDF or an MJCF: its robot.yaml and its MJCF");
  command->add_option("ROBOT", import.file, "ROBOT.urdf, with xacro run, or MODEL.xml of MuJoCo")
      ->required();
  command
      ->add_option("--out", import.out,
                   "The robot's folder, whose name becomes its own: models/NAME")
      ->required();
  command
      ->add_option("--package-path", import.choices.package_paths,
                   "DIR with ROS packages, or a package, for package:// [folders around ROBOT]")
      ->allow_extra_args(false);
  command->add_flag("--overwrite", import.overwrite, "Replace a robot that is there");
  command->add_option("--base", import.choices.base, "LINK that the robot begins with [the root]");
  command->add_option("--tip", import.choices.tip,
                      "LINK that it ends with, its tool [the one end that most joints lead to]");
  command
      ->add_option("--fix", options->fix,
                   "JOINT=VALUE: hold a joint there [rad, m]; those beside the chain are held at 0")
      ->allow_extra_args(false);
  CLI::Option* const cover =
      command
          ->add_option("--cover-mm", options->cover_mm,
                       "How far what can touch may stick out of the collision spheres [mm] [5]")
          ->check(NumberFrom(0.5, 100.0));
  command
      ->add_option("--spheres", import.spheres.num_spheres,
                   "Collision spheres of the whole robot, at most [as many as it takes]")
      ->check(NumberFrom(1, 1000))
      ->excludes(cover);
  command->add_flag("--cylinders-as-capsules", import.choices.cylinders_as_capsules,
                    "Round the ends of cylinders off, beyond them");
  command->add_flag("--visuals-as-collisions", import.choices.visuals_as_collisions,
                    "Of links without a collision, take what is drawn");
  command->add_flag("--repair-inertia", import.choices.repair_inertia,
                    "Mend inertias that no solid has, and masses that lack");
  command->add_flag("--keep-up-axis", options->keep_up_axis,
                    "Take COLLADA meshes as they are, as RViz does; else their up axis becomes z");
  command
      ->add_option("--hull-vertices", import.choices.max_hull_vertices,
                   "Corners of a mesh's convex hull, at most [200]")
      ->check(NumberFrom(8, 1000));
  command
      ->add_option("--velocity", import.choices.v_max,
                   "Greatest speed of joints that name none [rad/s, m/s]")
      ->check(NumberFrom(1e-3, 1e3));
  command
      ->add_option("--ramp-s", import.choices.ramp_s,
                   "Limit acceleration: to the greatest speed in that time [s] [no limit]")
      ->check(NumberFrom(1e-3, 100.0));
  command
      ->add_option("--bandwidth", import.bandwidth_rad_s,
                   "Of the joints' impedance control [rad/s] [50]")
      ->check(NumberFrom(1.0, 500.0));
  command
      ->add_option("--armature", import.armature_share,
                   "Inertia of each motor, as a share of the greatest that its joint moves [0.1]")
      ->check(NumberFrom(0.0, 10.0));
  command->footer(
      "Meshes become convex hulls. What was made of the file, and what was left out, is told.\n"
      "Then: sidestep check-robot FOLDER, and sidestep new-scenario --robot FOLDER --out "
      "FILE.yaml\n(docs/robots.md).");
  command->callback([&line, options] { line.exit_code = Import(*options); });
}

}  // namespace sidestep::cli
