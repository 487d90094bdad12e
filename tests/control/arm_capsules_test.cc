#include "sidestep/control/arm_capsules.h"

#include <gtest/gtest.h>

#include <string>

#include "sidestep/core/random.h"
#include "tests/support/allocations.h"

namespace sidestep::control {
namespace {

class ArmCapsulesOf : public ::testing::TestWithParam<std::string> {};

TEST_P(ArmCapsulesOf, AreWhereTheLinksAreAndAllocateNothing) {
  const Pose X_WB = Pose::FromRollPitchYaw({0.1, -0.2, 0.3}, {0.4, 0.5, 0.6});
  const robot::RobotModel robot =
      robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/" + GetParam() + "/robot.yaml", X_WB);
  const ArmCapsules capsules(robot);
  ASSERT_EQ(capsules.size(), static_cast<int>(robot.capsules().size()));
  ASSERT_GT(capsules.size(), 3);
  RandomStream random(1, "configurations");
  ArmCapsules::All placed;
  for (int i = 0; i < 100; ++i) {
    JointVector q(robot.num_joints());
    for (double& value : q) value = random.Uniform(-2, 2);
    const int before = CountAllocations().count;
    capsules.Place(q, placed);
    ASSERT_EQ(CountAllocations().count, before);
    const std::vector<Pose> links = robot.ComputeLinkPoses(q);
    for (std::size_t k = 0; k < robot.capsules().size(); ++k) {
      const robot::CollisionCapsule& capsule = robot.capsules()[k];
      const Pose X_WL = capsule.link < 0 ? X_WB : links[static_cast<std::size_t>(capsule.link)];
      EXPECT_LE((placed[k].a - X_WL * capsule.p_LA).norm(), 1e-12);
      EXPECT_LE((placed[k].b - X_WL * capsule.p_LB).norm(), 1e-12);
      EXPECT_EQ(placed[k].moves, capsule.link >= 0);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, ArmCapsulesOf,
                         ::testing::Values("models/panda", "tests/data/joint_tree"),
                         [](const auto& test) {
                           return test.param == "models/panda" ? "Panda" : "JointTree";
                         });

}  // namespace
}  // namespace sidestep::control
