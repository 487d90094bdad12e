#include "sidestep/import/sphere_roles.h"

#include <gtest/gtest.h>

#include "sidestep/import/home_candidates.h"

namespace sidestep::imports::sphere_roles_test {
namespace {

// An upright post with an arm of 0.5 m that swings up and down at its top, 0.4 m high, and a hand
// of 0.2 m that folds back along it.
robot::ArmDescription Swing() {
  robot::ArmDescription arm;
  const auto link = [](const char* name, double length_m) {
    robot::ArmLink made;
    made.name = name;
    robot::LinkSolid solid;
    solid.form = Box{{length_m, 0.04, 0.04}};
    solid.X_LS = Pose::Translation({length_m / 2, 0, 0});
    made.solids.push_back(solid);
    return made;
  };
  arm.links = {link("post", 0.04), link("arm", 0.5), link("hand", 0.2)};
  robot::Joint swing, fold;
  swing.name = "swing";
  swing.link = "arm";
  swing.X_PJ = Pose::Translation({0, 0, 0.4});
  swing.axis_J = Eigen::Vector3d::UnitY();
  swing.coordinate = 0;
  fold = swing;
  fold.name = "fold";
  fold.link = "hand";
  fold.parent = 0;
  fold.X_PJ = Pose::Translation({0.5, 0, 0});
  fold.coordinate = 1;
  arm.joints = {swing, fold};
  robot::JointLimits limits;
  limits.q_min = -2;
  limits.q_max = 3;
  arm.limits = {limits, limits};
  return arm;
}

std::vector<robot::CollisionSphere> Spheres() {
  return {{-1, {0, 0, 0}, 0.1},      // the post, which never moves
          {0, {0, 0, -0.35}, 0.05},  // hangs below the arm's root: goes round it
          {0, {0.25, 0, 0}, 0.05},
          {1, {0.2, 0, 0}, 0.05}};
}

TEST(MountSpheres, AreThoseThatNeverMoveOrAreAlwaysLow) {
  EXPECT_EQ(MountSpheres(Swing(), Spheres()), std::vector<int>{0});
  std::vector<robot::CollisionSphere> spheres = Spheres();
  spheres[1].radius_m = 0.8;  // reaches the ground whatever the arm does
  EXPECT_EQ(MountSpheres(Swing(), spheres), (std::vector<int>{0, 1}));
}

TEST(MountSpheres, AreAlsoThoseThatAreInTheGroundAtHome) {
  const std::vector<robot::CollisionSphere> spheres = Spheres();
  EXPECT_EQ(WithSpheresBelow(Swing(), spheres, {0}, Eigen::Vector2d(3, 0)), std::vector<int>{0});
  EXPECT_EQ(WithSpheresBelow(Swing(), spheres, {0}, Eigen::Vector2d(1.5, 0)),
            (std::vector<int>{0, 3}));
}

TEST(SeparablePairs, AreThoseWhoseSpheresAreApart) {
  const LinkPairs pairs = {{-1, 0}, {0, 1}};
  EXPECT_EQ(SeparablePairs(Swing(), Spheres(), pairs, Eigen::Vector2d(0, 0)).size(), 1u);
  // Turned by half a turn, what hung at the post stands above it.
  EXPECT_EQ(SeparablePairs(Swing(), Spheres(), pairs, Eigen::Vector2d(3, 0)).size(), 2u);
  // Folded back, the hand's sphere is within the arm's.
  EXPECT_EQ(SeparablePairs(Swing(), Spheres(), pairs, Eigen::Vector2d(3, 3)).size(), 1u);
}

TEST(Home, IsWhereTheFewestSpheresAreInTheWay) {
  const std::vector<Eigen::VectorXd> configurations = {
      Eigen::Vector2d(1.5, 0),   // the arm points down, into the ground
      Eigen::Vector2d(3, 3),     // the hand is folded onto the arm
      Eigen::Vector2d(3, 0.5)};  // nothing is in the way
  EXPECT_EQ(ChooseHome(Swing(), Spheres(), {0}, {{0, 1}}, configurations), Eigen::Vector2d(3, 0.5));
}

TEST(Home, IsLookedForWithinTheLimitsAndAboveTheGroundFirst) {
  const robot::ArmDescription arm = Swing();
  const std::vector<Eigen::VectorXd> candidates = HomeCandidates(arm);
  EXPECT_EQ(candidates.front(), Eigen::Vector2d(0, 0));
  for (const Eigen::VectorXd& q : candidates) {
    EXPECT_GE(q.minCoeff(), -2);
    EXPECT_LE(q.maxCoeff(), 3);
  }
}

}  // namespace
}  // namespace sidestep::imports::sphere_roles_test
