#include "sidestep/import/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>
#include <string>

namespace sidestep::imports::inverse_kinematics_test {
namespace {

struct Robot {
  std::string models, name;
};
void PrintTo(const Robot& robot, std::ostream* out) { *out << robot.name; }

class EveryArm : public ::testing::TestWithParam<Robot> {
 protected:
  const robot::RobotModel robot_ =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR + GetParam().models, GetParam().name,
                              Pose::FromRollPitchYaw({0.1, 0.2, 0.3}, {0.4, -0.2, 0.5}));
  const int link_ = static_cast<int>(robot_.joints().size()) - 1;

  Pose At(const Eigen::VectorXd& q) const { return robot_.ComputeLinkPoses(q).back(); }
  bool IsWithinLimits(const Eigen::VectorXd& q) const {
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const robot::JointLimits& limits = robot_.limits()[static_cast<std::size_t>(i)];
      if (q(i) < limits.q_min || q(i) > limits.q_max) return false;
    }
    return true;
  }
};

TEST_P(EveryArm, IsLedToWhereItsLinkIsAsked) {
  RandomStream random(1, "targets");
  int num_found = 0;
  for (int n = 0; n < 40; ++n) {
    const Pose X_WL = At(RandomConfiguration(robot_, random));
    const auto q = SolvePose(robot_, {link_, X_WL}, RandomConfiguration(robot_, random), 30, random,
                             [](const Eigen::VectorXd&) { return true; });
    if (!q) continue;
    ++num_found;
    EXPECT_TRUE(IsWithinLimits(*q));
    const Pose off = At(*q).Inverse() * X_WL;
    EXPECT_LT(off.translation().norm(), 1.01e-6);
    EXPECT_LT(2 * off.rotation().vec().norm(), 1.01e-6);
  }
  EXPECT_GE(num_found, 39);
}

TEST_P(EveryArm, IsNotLedToWhereItCannotReach) {
  RandomStream random(1, "targets");
  const Eigen::VectorXd q_near = RandomConfiguration(robot_, random);
  const auto q = SolvePose(robot_, {link_, Pose::Translation({50, 0, 0})}, q_near, 5, random,
                           [](const Eigen::VectorXd&) { return true; });
  EXPECT_FALSE(q.has_value());
}

TEST_P(EveryArm, GetsOnlyWhatIsGood) {
  RandomStream random(2, "targets");
  const Pose X_WL = At(RandomConfiguration(robot_, random));
  const auto q = SolvePose(robot_, {link_, X_WL}, RandomConfiguration(robot_, random), 30, random,
                           [](const Eigen::VectorXd&) { return false; });
  EXPECT_FALSE(q.has_value());
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryArm,
                         ::testing::Values(Robot{"/models", "panda"}, Robot{"/models", "wam"},
                                           Robot{"/examples/robot", "panda_rail"}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::imports::inverse_kinematics_test
