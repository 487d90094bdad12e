#include "sidestep/cli/checked_robots.h"

#include <cstdint>
#include <optional>

#include "sidestep/cli/wiring.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/model_name.h"
#include "sidestep/core/text_file.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/robot_agreement.h"

namespace sidestep::cli {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{1} << 30;  // readers of each kind allow less

bool AreSame(const Pose& a, const Pose& b) {
  return a.translation() == b.translation() && a.rotation().coeffs() == b.rotation().coeffs();
}

// None where it cannot be read: who makes something of it says why.
std::optional<std::string> TextOf(const std::string& path) {
  try {
    return ReadTextFile(path, kMostBytes);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

robot::RobotModel CheckedRobots::Get(const scenarios::Scenario& scenario,
                                     const ModelFolders& models) {
  const std::string path =
      RobotFolder(scenario, models) + "/" + DescriptionFile(scenario.robot_variant);
  const std::string mjcf_path = RobotMjcf(scenario, models);
  const std::optional<std::string> description = TextOf(path), mjcf = TextOf(mjcf_path);
  const auto known = checked_.find(path);
  if (known != checked_.end() && description == known->second.description &&
      mjcf == known->second.mjcf && AreSame(known->second.X_WB, scenario.X_WB)) {
    return known->second.robot;
  }
  robot::RobotModel robot = RobotOf(scenario, models);
  sim::CheckAgreement(robot, *sim::LoadArmFile(mjcf_path), mjcf_path);
  if (description && mjcf) {
    checked_.insert_or_assign(path, Checked{*description, *mjcf, scenario.X_WB, robot});
  }
  return robot;
}

}  // namespace sidestep::cli
