#pragma once

#include <map>
#include <string>

#include "sidestep/core/model_folders.h"
#include "sidestep/core/pose.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Robots that were read and compared with their MJCF, so that the many runs of a sweep, which
/// share one, need not do it each time. For one thread at a time.
class CheckedRobots {
 public:
  /// The robot of a scenario that has one, as RobotOf has it. It is read anew if a byte of
  /// robot.yaml or of the MJCF has changed. @throws InputError, also where the two disagree.
  robot::RobotModel Get(const scenarios::Scenario& scenario, const ModelFolders& models);

 private:
  struct Checked {
    std::string description, mjcf;  // the files' bytes
    Pose X_WB;
    robot::RobotModel robot;
  };
  std::map<std::string, Checked> checked_;  // by the description's path
};

}  // namespace sidestep::cli
