#include "sidestep/core/convex_polytope.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/core/shape.h"
#include "tests/support/random_points.h"

namespace sidestep::convex_polytope_test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

double DistanceToSegment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const double along = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - along * (b - a)).norm();
}

double DistanceToTriangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                          const Vector3d& c) {
  double least = std::min(
      {DistanceToSegment(p, a, b), DistanceToSegment(p, b, c), DistanceToSegment(p, c, a)});
  Eigen::Matrix3d frame;
  frame << b - a, c - a, (b - a).cross(c - a);
  if (std::abs(frame.determinant()) < 1e-12) return least;
  const Vector3d at = frame.inverse() * (p - a);
  if (at.x() >= 0 && at.y() >= 0 && at.x() + at.y() <= 1) {
    least = std::min(least, std::abs(at.z()) * frame.col(2).norm());
  }
  return least;
}

// The signed distance to the hull of few points, without the hull: every triangle of three of them
// is in it, and some of these are its surface; every plane of three that has all others on one side
// bounds it.
double DistanceBySearch(const Points& points, const Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity(), highest = -nearest;
  for (const Vector3d& a : points) {
    for (const Vector3d& b : points) {
      for (const Vector3d& c : points) {
        const Vector3d across = (b - a).cross(c - a);
        if (across.norm() < 1e-9) continue;
        nearest = std::min(nearest, DistanceToTriangle(p, a, b, c));
        const Vector3d normal = across.normalized();
        const bool bounds = std::all_of(points.begin(), points.end(), [&](const Vector3d& q) {
          return normal.dot(q - a) < 1e-12;
        });
        if (bounds) highest = std::max(highest, normal.dot(p - a));
      }
    }
  }
  return highest > 0 ? nearest : highest;
}

// All that makes a solid's surface of it.
void ExpectIsClosedAndConvex(const ConvexPolytope& hull, const Points& points) {
  const double rounding_m = 1e-11 * hull.half_extents_m().maxCoeff();
  double six_volumes = 0;
  for (const auto& triangle : hull.triangles()) {
    EXPECT_NEAR(triangle.normal.norm(), 1, 1e-14);
    for (const Vector3d& p : points) {
      EXPECT_LE(triangle.normal.dot(p), triangle.offset_m + rounding_m);
    }
    const auto corner = [&](std::size_t k) {
      return hull.vertices()[static_cast<std::size_t>(triangle.corners[k])];
    };
    const Vector3d across = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    EXPECT_GE(across.dot(triangle.normal), 0);
    six_volumes += corner(0).dot(corner(1).cross(corner(2)));
  }
  EXPECT_EQ(hull.triangles().size(), 2 * hull.vertices().size() - 4);  // Euler
  EXPECT_GT(six_volumes, 0);
}

Points Box8(const Vector3d& half) {
  Points points;
  for (int n = 0; n < 8; ++n) {
    points.push_back(half.cwiseProduct(Vector3d(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1)));
  }
  return points;
}

Points Cylinder(int sides, double radius_m, double half_m, const Eigen::Quaterniond& R) {
  Points points;
  for (int n = 0; n < sides; ++n) {
    const double angle = 2 * std::numbers::pi * n / sides;
    for (const double z : {-half_m, half_m}) {
      points.push_back(R * Vector3d(radius_m * std::cos(angle), radius_m * std::sin(angle), z));
    }
  }
  return points;
}

TEST(ConvexPolytope, OfABoxesCornersHasTheDistanceOfTheBox) {
  const Vector3d half(0.3, 0.2, 0.1);
  const ConvexPolytope hull(Box8(half));
  RandomStream random(1, "points");
  for (int n = 0; n < 3000; ++n) {
    const Vector3d p = UniformPoint(random, 0.5);
    EXPECT_NEAR(hull.SignedDistance(p), SignedDistance(Box{2 * half}, p), 1e-12) << p.transpose();
  }
  EXPECT_EQ(hull.edges().size(), 12u);  // none across its faces
  EXPECT_EQ(hull.half_extents_m(), half);
  EXPECT_NEAR(hull.thickness_m(), 0.2, 1e-12);
  ExpectIsClosedAndConvex(hull, hull.vertices());
}

TEST(ConvexPolytope, KeepsOnlyCorners) {
  const Points corners = Box8({0.3, 0.2, 0.1});
  Points points = {
      {0, 0, 0}, {0.3, 0, 0}, {0.3, 0.2, 0.05}, {-0.1, 0.2, 0.1}};  // inside, on faces, edges
  points.insert(points.end(), corners.begin(), corners.end());
  points.insert(points.end(), corners.begin(), corners.end());
  points.emplace_back(0.1, -0.2, 0.1);
  const ConvexPolytope hull(points);
  ASSERT_EQ(hull.vertices().size(), 8u);
  ExpectIsClosedAndConvex(hull, points);
}

TEST(ConvexPolytope, HasTheDistanceThatBruteForceFinds) {
  RandomStream random(2, "points");
  for (int trial = 0; trial < 12; ++trial) {
    Points points;
    for (int n = 0; n < 4 + trial; ++n) points.push_back(UniformPoint(random, 0.5));
    if (trial % 3 == 1) points.back() = (points[0] + points[1]) / 2;  // amid a possible edge
    const ConvexPolytope hull(points);
    ExpectIsClosedAndConvex(hull, points);
    for (int n = 0; n < 60; ++n) {
      const Vector3d p = UniformPoint(random, n % 2 == 0 ? 1 : 0.3);
      EXPECT_NEAR(hull.SignedDistance(p), DistanceBySearch(points, p), 1e-11) << p.transpose();
    }
  }
}

// On a lattice nearly every point lies in a plane or a line with others.
TEST(ConvexPolytope, OfPointsOfALatticeIsTheSmallestThatHoldsThem) {
  RandomStream random(3, "points");
  for (int trial = 0; trial < 60; ++trial) {
    Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int n = 0; n < 40; ++n) {
      const Vector3d p = UniformPoint(random, 2.5);
      points.push_back(p.array().round());
    }
    const ConvexPolytope hull(points);
    ExpectIsClosedAndConvex(hull, points);
    for (std::size_t left_out = 0; left_out < hull.vertices().size(); ++left_out) {
      Points others = hull.vertices();
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
      if (others.size() < 4) continue;
      try {
        EXPECT_GT(ConvexPolytope(others).SignedDistance(hull.vertices()[left_out]), 0.01);
      } catch (const std::invalid_argument&) {  // a plane is left of it
      }
    }
  }
}

TEST(ConvexPolytope, OfARoundThingOfManySidesHasFlatEnds) {
  RandomStream random(4, "turns");
  for (const int sides : {3, 4, 16, 64, 250}) {
    const Points points = Cylinder(sides, 0.2, 0.3, RandomPose(random, 1).rotation());
    const ConvexPolytope hull(points);
    EXPECT_EQ(hull.vertices(), points);
    ExpectIsClosedAndConvex(hull, points);
  }
  const ConvexPolytope upright(Cylinder(64, 0.2, 0.3, Eigen::Quaterniond::Identity()));
  EXPECT_EQ(upright.edges().size(), 3u * 64);
}

TEST(ConvexPolytope, OfItsCornersIsTheSameAgain) {
  RandomStream random(5, "points");
  Points points;
  for (int n = 0; n < 300; ++n) points.push_back(UniformPoint(random, 1));
  const ConvexPolytope hull(points), again(hull.vertices());
  EXPECT_EQ(again.vertices(), hull.vertices());
  for (int n = 0; n < 100; ++n) {
    const Vector3d p = UniformPoint(random, 2);
    EXPECT_EQ(again.SignedDistance(p), hull.SignedDistance(p));
  }
}

TEST(ConvexPolytope, IsTheSameWhateverItsSize) {
  const Points points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.7, 0.7, 0.7}};
  for (const double scale : {1e-9, 1e-3, 1.0, 1e6, 1e11}) {
    Points scaled;
    for (const Vector3d& p : points) scaled.push_back(scale * p);
    const ConvexPolytope hull(scaled);
    EXPECT_EQ(hull.triangles().size(), 6u);
    for (const Vector3d& p : {Vector3d(0.3, 0.2, 0.1), Vector3d(2, -1, 0.4)}) {
      EXPECT_NEAR(hull.SignedDistance(scale * p) / scale, DistanceBySearch(points, p), 1e-11);
    }
  }
}

std::string WhyNot(const Points& points) {
  try {
    const ConvexPolytope hull(points);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "";
}

TEST(ConvexPolytope, RefusesWhatIsNoSolid) {
  EXPECT_EQ(WhyNot({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), "must be at least 4 points");
  EXPECT_EQ(WhyNot({4, Vector3d::Zero()}), "are all one point");
  EXPECT_EQ(WhyNot({4, Vector3d::Ones()}), "are all one point");
  EXPECT_EQ(WhyNot({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), "lie on one line");
  EXPECT_EQ(WhyNot({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), "lie in one plane");
  EXPECT_EQ(WhyNot({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}), "must be finite");
  RandomStream random(6, "points");
  Points ball;
  for (int n = 0; n < 3000; ++n) ball.push_back(UniformPoint(random, 1).normalized());
  EXPECT_EQ(WhyNot(ball), "have 3000 corners, must be at most 1000");
}

}  // namespace
}  // namespace sidestep::convex_polytope_test
