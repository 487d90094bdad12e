#include "sidestep/cli/checked_robots.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

class CheckedRobotsOf : public ::testing::Test {
 protected:
  CheckedRobotsOf() {
    fs::copy(SIDESTEP_SOURCE_DIR "/examples/robot/pointer", folder_.path() / "pointer");
    scenario_.robot = "pointer";
  }

  double Speed() {
    const robot::RobotModel robot = robots_.Get(scenario_, ModelFolders(folder_.path().string()));
    return robot.limits()[0].v_max;
  }
  void Replace(const char* file, const std::string& what, const std::string& by) {
    const fs::path path = folder_.path() / "pointer" / file;
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    std::ofstream(path) << std::regex_replace(text.str(), std::regex(what), by);
  }

  TemporaryFolder folder_;
  scenarios::Scenario scenario_;
  CheckedRobots robots_;
};

TEST_F(CheckedRobotsOf, AreReadAnewWhenAByteOfThemHasChanged) {
  EXPECT_EQ(Speed(), 4);
  EXPECT_EQ(Speed(), 4);
  Replace("robot.yaml", "v_max_rad_s: 4", "v_max_rad_s: 3");
  EXPECT_EQ(Speed(), 3);
}

TEST_F(CheckedRobotsOf, AreComparedAnewWhenAByteOfTheirBodyHasChanged) {
  EXPECT_EQ(Speed(), 4);
  Replace("pointer.xml", "range=\"[^\"]*\"", "range=\"-1 1\"");
  EXPECT_THROW(Speed(), InputError);
  EXPECT_THROW(Speed(), InputError) << "what is wrong once stays wrong";
}

TEST_F(CheckedRobotsOf, StandWhereEachScenarioPutsThem) {
  const ModelFolders models(folder_.path().string());
  double at_origin_m = 0;
  for (const double x_m : {0.0, 1.0, 0.0}) {
    scenario_.X_WB = Pose::Translation({x_m, 0, 0});
    const robot::RobotModel robot = robots_.Get(scenario_, models);
    const Eigen::VectorXd q = Eigen::VectorXd::Zero(robot.num_joints());
    const double foot_m = robot.ComputeToolPose(q).translation().x();
    if (x_m == 0) at_origin_m = foot_m;
    EXPECT_DOUBLE_EQ(foot_m, at_origin_m + x_m);
  }
}

}  // namespace
}  // namespace sidestep::cli
