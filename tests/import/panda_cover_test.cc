// What models/panda/covered.yaml promises, held to it with other means than made it.

#include <gtest/gtest.h>

#include <limits>

#include "sidestep/import/sphere_cover.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/robot_agreement.h"
#include "sidestep/sim/robot_solids.h"

namespace sidestep::imports::panda_cover_test {
namespace {

const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

TEST(CoveredPanda, LeavesOutNoMoreThan5MmWithAtMost60SpheresAndAThirdMoreVolume) {
  const robot::RobotModel panda = robot::RobotModel::Load(kModels, "panda:covered", Pose());
  const std::string mjcf = kModels + "/panda/panda.xml";
  const sim::MujocoModelPtr model = sim::LoadArmFile(mjcf);
  sim::CheckAgreement(panda, *model, mjcf);
  EXPECT_LE(panda.num_spheres(), 60);
  double solid_m3 = 0, sphere_m3 = 0;
  int num_solids = 0;
  for (const sim::RigidLink& link : sim::FindRigidLinks(panda, *model)) {
    ASSERT_TRUE(link.has_solids());
    std::vector<CoverSphere> spheres;
    for (const robot::CollisionSphere& sphere : link.spheres) {
      spheres.push_back({sphere.p_LS, sphere.radius_m});
    }
    const CoverCheck check = CheckCover({link.shapes, {}}, spheres, 1e-5);
    EXPECT_LE(check.uncovered_m, 0.005) << link.link;
    solid_m3 += check.solid_m3;
    sphere_m3 += check.sphere_m3;
    num_solids += static_cast<int>(link.shapes.size());
  }
  EXPECT_EQ(num_solids, 35) << "the solids of panda.xml";
  EXPECT_LE(sphere_m3 / solid_m3 - 1, 0.35);
}

// Everything but the spheres is the same robot.
TEST(CoveredPanda, IsThePandaWithOtherSpheres) {
  const robot::RobotModel panda = robot::RobotModel::Load(kModels, "panda", Pose());
  const robot::RobotModel covered = robot::RobotModel::Load(kModels, "panda:covered", Pose());
  EXPECT_EQ(covered.name(), "panda");
  EXPECT_EQ(covered.file(), panda.file());
  EXPECT_EQ(covered.mount_links(), panda.mount_links());
  EXPECT_EQ(covered.configurations(), panda.configurations());
  EXPECT_EQ(covered.stiffness(), panda.stiffness());
  EXPECT_EQ(covered.capsules().size(), panda.capsules().size());
  // What stands on the table is its base, and no sphere of a link that moves is left out for it.
  ASSERT_FALSE(covered.mount_spheres().empty());
  for (int s = 0; s < covered.num_spheres(); ++s) {
    const auto& mount = covered.mount_spheres();
    const bool is_mount = std::find(mount.begin(), mount.end(), s) != mount.end();
    EXPECT_EQ(is_mount, covered.spheres()[static_cast<std::size_t>(s)].link < 0) << s;
  }
  for (const robot::LinkPair& pair : panda.self_collision()) {
    EXPECT_TRUE(std::any_of(covered.self_collision().begin(), covered.self_collision().end(),
                            [&](const robot::LinkPair& other) {
                              return other.first == pair.first && other.second == pair.second;
                            }))
        << pair.first << " " << pair.second;
  }
}

}  // namespace
}  // namespace sidestep::imports::panda_cover_test
