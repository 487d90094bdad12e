#include "sidestep/sim/convex_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "sidestep/core/pose.h"
#include "tests/sim/small_model.h"
#include "tests/support/random_points.h"

namespace sidestep::sim::convex_distance_test {
namespace {

using Core = ConvexSolid::Core;
using Eigen::Vector3d;

constexpr double kTolerance_m = 3e-9;

// A box as a hull whose vertices stand far from its frame's origin, or around it.
ConvexSolid HullOfBox(const Vector3d& centre_m, const Vector3d& half_m) {
  ConvexSolid solid;
  solid.core = Core::kHull;
  for (unsigned i = 0; i < 8; ++i) {
    const Vector3d sign((i & 1u) != 0 ? 1 : -1, (i & 2u) != 0 ? 1 : -1, (i & 4u) != 0 ? 1 : -1);
    solid.vertices.push_back(centre_m + sign.cwiseProduct(half_m));
  }
  return solid;
}

ConvexSolid Ball(double radius_m) { return {Core::kPoint, {0, 0, 0}, {}, radius_m}; }

// Where solid b is: at X, in the frame of solid a.
Eigen::Isometry3d At(const Pose& X) {
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = X.rotation().toRotationMatrix();
  isometry.translation() = X.translation();
  return isometry;
}
Eigen::Isometry3d At(const Vector3d& p) { return At(Pose::Translation(p)); }

const Vector3d kHalf = Vector3d::Constant(0.5);

struct Case {
  const char* name;
  ConvexSolid a, b;
  Vector3d p_AB;
  double distance_m;
};
std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }

const Case kCases[] = {
    {"CubeAheadAndAPointBehind", HullOfBox({10, 0, 0}, kHalf), Ball(0), {-1, 0, 0}, 10.5},
    {"CubeAheadAndAPointBeforeIt", HullOfBox({10, 0, 0}, kHalf), Ball(0), {9, 0, 0}, 0.5},
    {"CubeAheadAndAPointBeyond", HullOfBox({10, 0, 0}, kHalf), Ball(0), {12, 0, 0}, 1.5},
    {"CubeAheadAndAPointAtItsFrame", HullOfBox({10, 0, 0}, kHalf), Ball(0), {0, 0, 0}, 9.5},
    {"CubeAheadAndAPointInIt", HullOfBox({10, 0, 0}, kHalf), Ball(0), {10.1, 0.2, 0}, 0},
    {"CubeAheadAndABallAtItsFrame", HullOfBox({10, 0, 0}, kHalf), Ball(0.2), {0, 0, 0}, 9.3},
    {"CubeBehindAndAPointAhead", HullOfBox({-3, 0, 0}, kHalf), Ball(0), {1, 0, 0}, 3.5},
    {"CornerOfAFarCube",
     HullOfBox({3, 4, 5}, kHalf),
     Ball(0),
     {0, 0, 0},
     std::sqrt(2.5 * 2.5 + 3.5 * 3.5 + 4.5 * 4.5)},
    {"TwoFarCubes", HullOfBox({10, 0, 0}, kHalf), HullOfBox({0, 10, 0}, kHalf), {10, 0, 0}, 9},
    {"TwoFarCubesInOnePlace",
     HullOfBox({10, 0, 0}, kHalf),
     HullOfBox({0, 10, 0}, kHalf),
     {10, -10.2, 0},
     0},
    {"FarCubeAndABox",
     HullOfBox({10, 0, 0}, kHalf),
     {Core::kBox, {0.1, 0.2, 0.3}, {}, 0},
     {-1, 0, 0},
     10.4},
};

class ClosedForm : public ::testing::TestWithParam<Case> {};

TEST_P(ClosedForm, IsTheDistanceAndTheSameTheOtherWayRound) {
  const Case& c = GetParam();
  EXPECT_NEAR(ConvexDistance(c.a, c.b, At(c.p_AB)), c.distance_m, kTolerance_m);
  EXPECT_NEAR(ConvexDistance(c.b, c.a, At(-c.p_AB)), c.distance_m, kTolerance_m);
}

INSTANTIATE_TEST_SUITE_P(ConvexDistance, ClosedForm, ::testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(ConvexDistance, OfAHullIsThatOfTheBoxWhereverItsFrameIs) {
  RandomStream random(11, "poses");
  const Vector3d half(0.1, 0.2, 0.3);
  const ConvexSolid box{Core::kBox, half, {}, 0};
  const ConvexSolid others[] = {Ball(0.1),
                                {Core::kSegment, {0, 0, 0.2}, {}, 0.05},
                                {Core::kCylinder, {0.1, 0, 0.2}, {}, 0},
                                {Core::kEllipsoid, {0.1, 0.15, 0.2}, {}, 0},
                                HullOfBox({-2, 1, 4}, half)};
  for (const ConvexSolid& other : others) {
    for (int trial = 0; trial < 200; ++trial) {
      const Pose X_AB = RandomPose(random, 1.5);
      const Vector3d offset = UniformPoint(random, 20);
      const double expected = ConvexDistance(box, other, At(X_AB));
      const Pose X_moved(X_AB.rotation(), X_AB.translation() + offset);
      EXPECT_NEAR(ConvexDistance(HullOfBox(offset, half), other, At(X_moved)), expected,
                  kTolerance_m);
    }
  }
}

}  // namespace
}  // namespace sidestep::sim::convex_distance_test
