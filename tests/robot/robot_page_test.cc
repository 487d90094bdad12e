#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "sidestep/robot/robot_model.h"
#include "tests/support/key_page.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::robot {
namespace {

TEST(RobotPage, TellsEveryKeyAsTheReaderHasIt) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "robot.yaml").string();
  const auto read = [&path](const std::string& text) {
    std::ofstream(path) << text;
    const RobotModel robot = RobotModel::FromFile(path, Pose());
    std::ostringstream limits;  // what may be left out
    for (const JointLimits& one : robot.limits()) {
      limits << one.q_min << " " << one.q_max << " " << one.v_max << " " << one.a_max << " "
             << one.jerk_max << " " << one.torque_max << "\n";
    }
    limits << robot.tool_limits().a_max << " " << robot.tool_limits().a_reflex << "\n";
    const Eigen::VectorXd q = Eigen::VectorXd::Constant(robot.num_joints(), 0.3);
    limits << robot.ComputeSphereCenters(q, false).p_WS << robot.ComputeToolPose(q).translation();
    return limits.str();
  };
  for (const std::string& difference :
       KeyPage(SIDESTEP_SOURCE_DIR "/docs/robots.md", read).Differences()) {
    ADD_FAILURE() << difference;
  }
}

}  // namespace
}  // namespace sidestep::robot
