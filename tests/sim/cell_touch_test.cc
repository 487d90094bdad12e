// Which cubes a shape reaches into, against the convex distance between cube and shape.
#include "sidestep/core/cell_touch.h"

#include <gtest/gtest.h>

#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/sim/convex_distance.h"
#include "tests/sim/small_model.h"
#include "tests/support/random_points.h"

namespace sidestep::sim::cell_touch_test {
namespace {

using Eigen::Vector3d;
using Core = ConvexSolid::Core;

constexpr double kEdge_m = 0.04;
constexpr double kMargin_m = 1e-6;  // nearer to the limit than this, either answer is right

struct Case {
  std::string name;
  Shape shape;
  ConvexSolid solid;  // the same
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

double CubeDistance(const Case& c, const Pose& X_WO, const Vector3d& p_WCenter, double edge_m) {
  const ConvexSolid cube{Core::kBox, Vector3d::Constant(edge_m / 2), {}, 0};
  Eigen::Isometry3d X_CO = Eigen::Isometry3d::Identity();
  X_CO.linear() = X_WO.rotation().toRotationMatrix();
  X_CO.translation() = X_WO.translation() - p_WCenter;
  return ConvexDistance(cube, c.solid, X_CO);
}

// Of a shard and of a needle.
Case MeshCase(const std::string& name, const Vector3d& size_m) {
  RandomStream random(4, name);
  std::vector<Vector3d> points;
  for (int n = 0; n < 25; ++n) points.push_back(size_m.cwiseProduct(UniformPoint(random, 1)));
  return {name,
          ConvexMesh{std::make_shared<const ConvexPolytope>(points)},
          {Core::kHull, {0, 0, 0}, points, 0}};
}

class TouchedCubes : public testing::TestWithParam<Case> {};

TEST_P(TouchedCubes, AreThoseWhoseDistanceToTheShapeIsNone) {
  RandomStream random(3, "poses");
  const Vector3d half = HalfExtents(GetParam().shape);
  int num_touched = 0, num_free = 0, num_close = 0;
  for (int trial = 0; trial < 60; ++trial) {
    // Turned any way, a quarter turn, and hardly at all.
    Pose X_WO = RandomPose(random, 0.5);
    if (trial % 4 == 1) X_WO = Pose::FromRollPitchYaw({0, 0, M_PI / 2}, X_WO.translation());
    if (trial % 4 == 2) X_WO = Pose::FromRollPitchYaw({0, 1e-9, 1e-5}, X_WO.translation());
    const CubeTouch touch(GetParam().shape, X_WO.rotation().toRotationMatrix(), X_WO.translation(),
                          kEdge_m);
    for (int n = 0; n < 400; ++n) {
      Vector3d p_O = UniformPoint(random, 1).cwiseProduct(half);
      // Half of them about the surface, where it is hard to tell.
      if (n % 2 == 0) p_O(n / 2 % 3) = (n % 4 == 0 ? 1 : -1) * half(n / 2 % 3);
      const Vector3d p_W = X_WO * p_O + UniformPoint(random, kEdge_m);
      const bool certainly = CubeDistance(GetParam(), X_WO, p_W, kEdge_m - 2 * kMargin_m) == 0;
      const bool certainly_not = CubeDistance(GetParam(), X_WO, p_W, kEdge_m + 2 * kMargin_m) > 0;
      if (!certainly && !certainly_not) {
        ++num_close;
        continue;
      }
      (certainly ? num_touched : num_free) += 1;
      ASSERT_EQ(touch(p_W), certainly)
          << "trial " << trial << ", centre in O: " << (X_WO.Inverse() * p_W).transpose();
    }
  }
  EXPECT_GT(num_touched, 1000);
  EXPECT_GT(num_free, 1000);
  EXPECT_LT(num_close, 100);
}

INSTANTIATE_TEST_SUITE_P(
    CubeTouch, TouchedCubes,
    testing::Values(
        Case{"Box", Box{{0.2, 0.3, 0.1}}, {Core::kBox, {0.1, 0.15, 0.05}, {}, 0}},
        Case{"Sheet", Box{{0.5, 0.02, 0.5}}, {Core::kBox, {0.25, 0.01, 0.25}, {}, 0}},
        Case{"Sphere", Sphere{0.11}, {Core::kPoint, {0, 0, 0}, {}, 0.11}},
        Case{"Bead", Sphere{0.005}, {Core::kPoint, {0, 0, 0}, {}, 0.005}},
        Case{"Capsule", Capsule{0.06, 0.2}, {Core::kSegment, {0, 0, 0.1}, {}, 0.06}},
        Case{"Wire", Capsule{0.004, 0.5}, {Core::kSegment, {0, 0, 0.25}, {}, 0.004}},
        Case{"Cylinder", Cylinder{0.1, 0.2}, {Core::kCylinder, {0.1, 0, 0.1}, {}, 0}},
        Case{"Pole", Cylinder{0.015, 0.6}, {Core::kCylinder, {0.015, 0, 0.3}, {}, 0}},
        Case{"Disc", Cylinder{0.2, 0.01}, {Core::kCylinder, {0.2, 0, 0.005}, {}, 0}},
        Case{"Ellipsoid", Ellipsoid{{0.1, 0.2, 0.05}}, {Core::kEllipsoid, {0.1, 0.2, 0.05}, {}, 0}},
        Case{"Lens", Ellipsoid{{0.2, 0.2, 0.006}}, {Core::kEllipsoid, {0.2, 0.2, 0.006}, {}, 0}},
        MeshCase("Mesh", {0.2, 0.15, 0.1}), MeshCase("Shard", {0.2, 0.2, 0.004}),
        MeshCase("Needle", {0.004, 0.004, 0.3})),
    [](const auto& test) { return test.param.name; });

TEST(CubeTouch, DoesNotCountCubesThatOnlyShareAFace) {
  const Shape box = Box{{0.4, 0.4, 0.4}};
  const CubeTouch touch(box, Eigen::Matrix3d::Identity(), Vector3d::Zero(), 0.1);
  EXPECT_TRUE(touch({0.15, 0, 0}));
  EXPECT_FALSE(touch({0.25, 0, 0}));
  EXPECT_TRUE(touch({0.2499, 0, 0}));
}

}  // namespace
}  // namespace sidestep::sim::cell_touch_test
