#include "sidestep/control/arm_capsules.h"

#include <gtest/gtest.h>

#include "sidestep/core/random.h"
#include "tests/support/allocations.h"

namespace sidestep::control {
namespace {

TEST(ArmCapsules, AreWhereTheLinksAreAndAllocateNothing) {
  const Pose X_WB = Pose::FromRollPitchYaw({0.1, -0.2, 0.3}, {0.4, 0.5, 0.6});
  const robot::RobotModel panda =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", X_WB);
  const ArmCapsules capsules(panda);
  ASSERT_EQ(capsules.size(), static_cast<int>(panda.capsules().size()));
  ASSERT_GT(capsules.size(), 8);
  RandomStream random(1, "configurations");
  ArmCapsules::All placed;
  for (int i = 0; i < 100; ++i) {
    JointVector q(panda.num_joints());
    for (double& value : q) value = random.Uniform(-2, 2);
    const int before = CountAllocations().count;
    capsules.Place(q, placed);
    ASSERT_EQ(CountAllocations().count, before);
    const std::vector<Pose> links = panda.ComputeLinkPoses(q);
    for (std::size_t k = 0; k < panda.capsules().size(); ++k) {
      const robot::CollisionCapsule& capsule = panda.capsules()[k];
      const Pose X_WL = capsule.link < 0 ? X_WB : links[static_cast<std::size_t>(capsule.link)];
      EXPECT_LE((placed[k].a - X_WL * capsule.p_LA).norm(), 1e-12);
      EXPECT_LE((placed[k].b - X_WL * capsule.p_LB).norm(), 1e-12);
      EXPECT_EQ(placed[k].moves, capsule.link >= 0);
    }
  }
}

}  // namespace
}  // namespace sidestep::control
