#include "sidestep/cli/import_robot.h"

#include <algorithm>
#include <filesystem>

#include "sidestep/cli/console.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/shell_quote.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/import/arm_of_tree.h"
#include "sidestep/import/arm_pose.h"
#include "sidestep/import/bounding_capsule.h"
#include "sidestep/import/home_candidates.h"
#include "sidestep/import/hull_finish.h"
#include "sidestep/import/isolated.h"
#include "sidestep/import/link_spheres.h"
#include "sidestep/import/robot_files.h"
#include "sidestep/import/sphere_roles.h"
#include "sidestep/import/urdf_tree.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/arm_survey.h"
#include "sidestep/sim/robot_agreement.h"
#include "sidestep/sim/tree_reader.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kConfigurations = 2000;

std::string NameOf(const std::string& out) {
  fs::path folder = fs::path(out).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  const std::string name = folder.filename().string();
  if (name.find(':') != std::string::npos) {
    throw InputError("--out", "must be a name without a colon, is '" + out + "'");
  }
  if (name.empty() || name == "." || name == "..") {
    throw InputError("--out", "must be a folder whose name is the robot's, is '" + out + "'");
  }
  return name;
}

robot::RobotTree ReadTree(const std::string& file, const imports::ArmChoices& choices) {
  if (fs::path(file).extension() != ".xml") return imports::ReadUrdfTree(file, choices);
  const auto read = [&] { return sim::ReadMjcfTree(file, choices.visuals_as_collisions); };
  // MuJoCo is no safer than others with damaged files: once where that does no harm.
  try {
    const auto try_it = [&] { return read().file; };
    static_cast<void>(imports::RunIsolated(try_it));
  } catch (const std::runtime_error& error) {
    throw imports::AsInputError(file, error);
  }
  robot::RobotTree tree = read();
  FinishHulls(choices, &tree);
  return tree;
}

std::string Spelled(const robot::ArmDescription& arm, const imports::LinkPairs& pairs) {
  return Joined(pairs, ", ", [&arm](const robot::LinkPair& pair) {
    return arm.LinkOf(pair.first).name + " and " + arm.LinkOf(pair.second).name;
  });
}

// Of each link that can touch; none if they would be too many.
std::vector<robot::CollisionCapsule> CapsulesOf(const robot::ArmDescription& arm) {
  std::vector<robot::CollisionCapsule> capsules;
  for (int link = -1; link < static_cast<int>(arm.joints.size()); ++link) {
    const std::vector<robot::LinkSolid>& solids = arm.LinkOf(link).solids;
    if (solids.empty()) continue;
    capsules.push_back(imports::CapsuleAround(solids));
    capsules.back().link = link;
  }
  if (capsules.size() > robot::RobotModel::kMaxCapsules) capsules.clear();
  return capsules;
}

// Of the joints that move; those that mimic them are driven through them.
void SetArmature(const Eigen::VectorXd& armature, robot::ArmDescription* arm) {
  int coordinate = 0;
  for (std::size_t i = 0; i < arm->joints.size(); ++i) {
    if (arm->joints[i].coordinate != coordinate) continue;
    if (arm->dynamics[i].armature == 0) arm->dynamics[i].armature = armature(coordinate);
    ++coordinate;
  }
}

// All of robot.yaml that is not the arm itself. Says what a person should know of it.
imports::RobotDetails DetailsOf(const robot::ArmDescription& arm, const sim::ArmSurvey& survey,
                                const imports::SphereRequest& spheres) {
  imports::RobotDetails details;
  Print("looking for collision spheres\n");  // it may take a minute
  details.spheres = imports::CoverArm(arm, spheres);
  details.capsules = CapsulesOf(arm);
  if (details.capsules.empty()) {
    Print(
        "more than {} links can touch: no capsules are written, by which it would be supervised\n",
        robot::RobotModel::kMaxCapsules);
  }
  const std::vector<int> mount = imports::MountSpheres(arm, details.spheres);
  details.home = imports::ChooseHome(arm, details.spheres, mount, survey.sometimes, survey.free);
  details.mount_spheres = imports::WithSpheresBelow(arm, details.spheres, mount, details.home);
  if (const std::size_t more = details.mount_spheres.size() - mount.size(); more > 0) {
    Print("{} spheres of what moves reach below the base wherever it was put: they are mounted\n",
          more);
  }
  details.self_collision =
      imports::SeparablePairs(arm, details.spheres, survey.sometimes, details.home);
  details.stiffness = survey.stiffness;
  details.damping = survey.damping;
  details.bandwidth_rad_s = survey.bandwidth_rad_s;
  return details;
}

// The two files, held to each other.
robot::RobotModel WriteRobot(const OutFolder& folder, const robot::ArmDescription& arm,
                             const imports::RobotDetails& details,
                             const imports::LinkPairs& without_contact) {
  const std::string xml_path = folder.path() + "/" + arm.name + ".xml";
  const std::string yaml_path = folder.path() + "/robot.yaml";
  WriteFile(xml_path, imports::MjcfText(arm, without_contact));
  WriteFile(yaml_path, imports::RobotYamlText(arm, details));
  robot::RobotModel robot = robot::RobotModel::FromFile(yaml_path, Pose());
  sim::CheckAgreement(robot, *sim::LoadArmFile(xml_path), xml_path);
  return robot;
}

}  // namespace

void ImportRobot(const RobotImport& request) {
  imports::ArmChoices choices = request.choices;
  choices.name = NameOf(request.out);
  const std::string xml_name = choices.name + ".xml";
  std::error_code error;
  for (const std::string& name : {std::string("robot.yaml"), xml_name}) {
    const fs::path path = fs::path(request.out) / name;
    if (fs::equivalent(path, request.file, error)) {
      throw InputError("--out", "'" + path.string() + "' would replace what is imported");
    }
    if (!request.overwrite && fs::exists(path, error)) {
      throw InputError("--out",
                       "'" + path.string() + "' is there already; --overwrite replaces it");
    }
  }
  OutFolder folder(request.out, {"robot.yaml", xml_name});  // before the work is done
  folder.Lock();
  imports::ImportedArm imported = imports::ArmOfTree(ReadTree(request.file, choices), choices);
  robot::ArmDescription& arm = imported.arm;
  for (const std::string& note : imported.notes) Print("{}\n", note);

  imports::LinkPairs without_contact = imports::PairsWithoutContact(arm, {});
  const sim::MujocoModelPtr model =
      sim::LoadArmText(imports::MjcfText(arm, without_contact), request.file + ": its MJCF");
  sim::SurveySettings settings;
  settings.configurations = imports::SampleConfigurations(arm, kConfigurations);
  settings.candidates = imports::HomeCandidates(arm);
  settings.bandwidth_rad_s = request.bandwidth_rad_s;
  settings.armature_share = request.armature_share;
  const sim::ArmSurvey survey = sim::SurveyArm(*model, arm, settings);
  if (survey.free.empty()) {
    throw InputError(request.file,
                     "it touches itself wherever it was put; are its collisions right?");
  }
  if (!survey.always.empty()) {
    Print("touch each other nearly always, which is left out: {}\n", Spelled(arm, survey.always));
    without_contact = imports::PairsWithoutContact(arm, survey.always);
  }
  SetArmature(survey.armature, &arm);
  const robot::RobotModel robot =
      WriteRobot(folder, arm, DetailsOf(arm, survey, request.spheres), without_contact);
  Print(
      "{}: {} joints, {} links, {} spheres, {} pairs of links to be kept apart (of {} that touch "
      "at some of {} configurations)\n",
      choices.name, robot.num_joints(), arm.links.size(), robot.num_spheres(),
      robot.self_collision().size(), survey.sometimes.size(), kConfigurations);
  Print("written  {0}/robot.yaml and {0}/{1}.xml\n", request.out, choices.name);
  const bool is_path = request.out.find('/') != std::string::npos;
  Print("next     sidestep new-scenario --robot {}{} --out {}.yaml\n", is_path ? "" : "./",
        ShellQuoted(request.out), ShellQuoted(choices.name));
}

}  // namespace sidestep::cli
