#include "sidestep/import/convex_hull.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "sidestep/core/random.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports::convex_hull_test {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

Matrix3Xd RandomPoints(int count, RandomStream* random) {
  Matrix3Xd points(3, count);
  for (double& value : points.reshaped()) value = random->Uniform(-1, 1);
  return points;
}

// The farthest plane of a hull from a point, by every face.
double HeightOver(const robot::HullSolid& hull, const Vector3d& p) {
  double height = -std::numeric_limits<double>::infinity();
  for (const auto& t : hull.triangles.colwise()) {
    const Vector3d a = hull.vertices.col(t(0)), b = hull.vertices.col(t(1));
    const Vector3d normal = (b - a).cross(Vector3d(hull.vertices.col(t(2)) - a)).normalized();
    height = std::max(height, normal.dot(p - a));
  }
  return height;
}

TEST(ConvexHull, OfACubeIsItsCornersWhateverLiesWithin) {
  RandomStream random(3, "cube");
  Matrix3Xd points(3, 108);
  points.leftCols(100) = 0.9 * RandomPoints(100, &random);
  for (int corner = 0; corner < 8; ++corner) {
    points.col(100 + corner) << (corner & 1 ? 1 : -1), (corner & 2 ? 1 : -1), (corner & 4 ? 1 : -1);
  }
  const auto hull = ConvexHullOf(points.colwise() + Vector3d(5, -3, 100));
  ASSERT_TRUE(hull.has_value());
  EXPECT_EQ(hull->vertices.cols(), 8);
  EXPECT_EQ(hull->triangles.cols(), 12);
  EXPECT_NEAR(SignedVolume_m3({hull->vertices, hull->triangles}), 8, 1e-9);
}

TEST(ConvexHull, HoldsEveryPointAndHasOnlyCorners) {
  RandomStream random(4, "hull");
  for (int trial = 0; trial < 20; ++trial) {
    const Matrix3Xd points = RandomPoints(5 + 10 * trial, &random);
    const auto hull = ConvexHullOf(points);
    ASSERT_TRUE(hull.has_value());
    for (const auto& p : points.colwise()) EXPECT_LT(HeightOver(*hull, p), 1e-12);
    // Euler: a closed surface of triangles.
    EXPECT_EQ(hull->triangles.cols(), 2 * hull->vertices.cols() - 4);
    EXPECT_GT(SignedVolume_m3({hull->vertices, hull->triangles}), 0);
  }
}

TEST(ConvexHull, IsNoneOfWhatSpansNoSolid) {
  RandomStream random(5, "flat");
  EXPECT_FALSE(ConvexHullOf(RandomPoints(3, &random)).has_value());
  Matrix3Xd flat = RandomPoints(50, &random);
  flat.row(2) *= kFlat_m / 4;
  EXPECT_FALSE(ConvexHullOf(flat).has_value());
  flat = Eigen::Quaterniond(1, 2, 3, 4).normalized().toRotationMatrix() * flat;
  EXPECT_FALSE(ConvexHullOf(flat).has_value());
  EXPECT_FALSE(ConvexHullOf(Matrix3Xd::Ones(3, 10)).has_value());
}

TEST(SimplerHull, SaysHowFarWhatItLeavesOutStandsOut) {
  RandomStream random(6, "ball");
  Matrix3Xd points = RandomPoints(3000, &random);
  points.colwise().normalize();
  const auto whole = ConvexHullOf(points);
  ASSERT_TRUE(whole.has_value());
  ASSERT_EQ(whole->vertices.cols(), 3000);
  double before_m = 1;
  for (const int most : {12, 50, 200}) {
    const SimplerHull simpler = Simplify(*whole, most);
    EXPECT_LE(simpler.hull.vertices.cols(), most);
    double outside_m = 0;
    for (const auto& p : points.colwise()) {
      outside_m = std::max(outside_m, HeightOver(simpler.hull, p));
    }
    EXPECT_NEAR(simpler.outside_m, outside_m, 1e-9);
    EXPECT_LT(simpler.outside_m, before_m);
    before_m = simpler.outside_m;
  }
  EXPECT_LT(before_m, 0.03);  // of a ball of 1 m
}

TEST(SimplerHull, IsTheHullWhereItHasFewCorners) {
  RandomStream random(7, "few");
  const auto whole = ConvexHullOf(RandomPoints(20, &random));
  const SimplerHull simpler = Simplify(*whole, 20);
  EXPECT_EQ(simpler.outside_m, 0);
  EXPECT_EQ(simpler.hull.vertices, whole->vertices);
}

}  // namespace
}  // namespace sidestep::imports::convex_hull_test
