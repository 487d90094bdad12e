// The Panda covered anew: what the search for covers must reach.

#include <gtest/gtest.h>

#include <iostream>

#include "sidestep/import/sphere_cover.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/robot_solids.h"

namespace sidestep::imports {
namespace {

std::vector<LinkSolids> Panda() {
  const std::string models = SIDESTEP_SOURCE_DIR "/models";
  const robot::RobotModel panda = robot::RobotModel::Load(models, "panda", Pose());
  std::vector<LinkSolids> solids;
  const sim::MujocoModelPtr model = sim::LoadArmFile(models + "/panda/panda.xml");
  for (const sim::RigidLink& link : sim::FindRigidLinks(panda, *model)) {
    solids.push_back({link.shapes, {}});
  }
  return solids;
}

void ExpectCovered(const std::vector<LinkSolids>& solids, const RobotCover& cover) {
  std::cout << cover.num_spheres() << " spheres, " << 1e3 * cover.cover_m << " mm, "
            << 100 * cover.excess() << " % more volume\n";
  EXPECT_LE(cover.excess(), 0.35);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    EXPECT_LE(CheckCover(solids[i], cover.links[i].spheres, 1e-5).uncovered_m, cover.cover_m) << i;
  }
}

TEST(PandaCoveredAnew, Takes40SpheresFor5Mm) {
  const std::vector<LinkSolids> solids = Panda();
  const RobotCover cover = CoverLinks(solids, {0.005, 0, 0.35});
  ExpectCovered(solids, cover);
  EXPECT_LE(cover.num_spheres(), 40);
}

TEST(PandaCoveredAnew, TakesAQuarterMoreVolumeWith60Spheres) {
  const std::vector<LinkSolids> solids = Panda();
  const RobotCover cover = CoverLinks(solids, {0.005, 60, 0.35});
  ExpectCovered(solids, cover);
  EXPECT_LE(cover.num_spheres(), 60);
  EXPECT_LE(cover.excess(), 0.25);
}

TEST(PandaCoveredAnew, Reaches12MmWith25Spheres) {
  const std::vector<LinkSolids> solids = Panda();
  const RobotCover cover = CoverLinks(solids, {0, 25, 0.35});
  ExpectCovered(solids, cover);
  EXPECT_LE(cover.num_spheres(), 25);
  EXPECT_LE(cover.cover_m, 0.012);
}

}  // namespace
}  // namespace sidestep::imports
