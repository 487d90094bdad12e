#include "sidestep/core/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "tests/support/random_points.h"

namespace sidestep::shape_test {
namespace {

using Eigen::Vector3d;

// Shapes as sets: whether a point is inside, said independently of any distance.
bool IsInside(const Shape& shape, const Vector3d& p) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    return (p.cwiseAbs().array() < box->size_m.array() / 2).all();
  }
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return p.norm() < sphere->radius_m;
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return std::hypot(p.x(), p.y()) < cylinder->radius_m &&
           std::abs(p.z()) < cylinder->length_m / 2;
  }
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    const Vector3d cap(0, 0, capsule->length_m / 2);
    return (std::hypot(p.x(), p.y()) < capsule->radius_m && std::abs(p.z()) < cap.z()) ||
           (p - cap).norm() < capsule->radius_m || (p + cap).norm() < capsule->radius_m;
  }
  const Vector3d& axes = std::get<Ellipsoid>(shape).semi_axes_m;
  return p.cwiseQuotient(axes).squaredNorm() < 1;
}

// Where the ray from the centre along `direction` leaves the shape.
Vector3d SurfacePoint(const Shape& shape, const Vector3d& direction) {
  double inside = 0, outside = 2 * HalfExtents(shape).norm() / direction.norm();
  for (int i = 0; i < 60; ++i) {
    const double middle = (inside + outside) / 2;
    (IsInside(shape, middle * direction) ? inside : outside) = middle;
  }
  return inside * direction;
}

// h(n) = max over the shape's points x of n x: how far it reaches along n.
double SupportFunction(const Shape& shape, const Vector3d& n) {
  const double across = std::hypot(n.x(), n.y()), along = std::abs(n.z());
  if (const auto* box = std::get_if<Box>(&shape)) return box->size_m.dot(n.cwiseAbs()) / 2;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius_m;
  if (const auto* capsule = std::get_if<Capsule>(&shape)) {
    return capsule->radius_m + capsule->length_m / 2 * along;
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    return cylinder->radius_m * across + cylinder->length_m / 2 * along;
  }
  return std::get<Ellipsoid>(shape).semi_axes_m.cwiseProduct(n).norm();
}

// The direction through the point (u, v) of a face of the cube [-1, 1]^3.
Vector3d Direction(int face, double u, double v) {
  Vector3d p;
  p(face / 2) = face % 2 == 0 ? 1 : -1;
  p((face / 2 + 1) % 3) = u;
  p((face / 2 + 2) % 3) = v;
  return p.normalized();
}

// The signed distance by brute force. A convex set is the intersection of its supporting
// half-spaces, so its signed distance is the largest n p - h(n) over all unit vectors n, inside and
// outside alike: scan all directions, then refine around the best.
double DistanceBySearch(const Shape& shape, const Vector3d& p) {
  struct Start {
    double height;
    int face;
    double u, v;
  };
  const auto height = [&](int face, double u, double v) {
    const Vector3d n = Direction(face, u, v);
    return n.dot(p) - SupportFunction(shape, n);
  };
  constexpr int kSteps = 48;
  constexpr int kStarts = 8;
  constexpr int kWays = 64;
  std::vector<Start> starts;
  for (int face = 0; face < 6; ++face) {
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; j <= kSteps; ++j) {
        const double u = 2.0 * i / kSteps - 1, v = 2.0 * j / kSteps - 1;
        starts.push_back({height(face, u, v), face, u, v});
      }
    }
  }
  std::partial_sort(starts.begin(), starts.begin() + kStarts, starts.end(),
                    [](const Start& a, const Start& b) { return a.height > b.height; });
  double best = starts[0].height;
  for (auto start = starts.begin(); start != starts.begin() + kStarts; ++start) {
    Start at = *start;
    for (double step = 1.0 / kSteps; step > 1e-9; step /= 2) {
      for (bool moved = true; moved;) {
        moved = false;
        // So many ways, for the one that leads up from a ridge of the height may be narrow.
        for (int way = 0; way < kWays; ++way) {
          const double angle = 2 * std::numbers::pi * way / kWays;
          const double u = std::clamp(at.u + step * std::cos(angle), -1.0, 1.0);
          const double v = std::clamp(at.v + step * std::sin(angle), -1.0, 1.0);
          const double h = height(at.face, u, v);
          if (h > at.height) {
            at = {h, at.face, u, v};
            moved = true;
          }
        }
      }
    }
    best = std::max(best, at.height);
  }
  return best;
}

struct Case {
  std::string name;
  Shape shape;
};
std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }

class EveryShape : public ::testing::TestWithParam<Case> {
 protected:
  const Shape& shape() const { return GetParam().shape; }

  // Points in a box twice the shape's size, about one in eight inside the shape's own box.
  std::vector<Vector3d> Points(int count) const {
    RandomStream random(5, "points");
    std::vector<Vector3d> points;
    for (int i = 0; i < count; ++i) {
      points.push_back(UniformPoint(random, 2).cwiseProduct(HalfExtents(shape())));
    }
    return points;
  }
};

TEST_P(EveryShape, HasTheDistanceThatBruteForceFinds) {
  std::vector<Vector3d> points = Points(40);
  // Where formulas break: the centre, the axes and the planes between them.
  const Vector3d half = HalfExtents(shape());
  for (const double scale : {0.0, 1e-9, 0.3, 0.97, 1.6}) {
    points.push_back(scale * Vector3d(half.x(), 0, 0));
    points.push_back(scale * Vector3d(0, half.y(), 0));
    points.push_back(scale * Vector3d(0, 0, -half.z()));
    points.push_back(scale * Vector3d(half.x(), half.y(), 0) * 0.7);
    points.push_back(scale * Vector3d(0, -half.y(), half.z()) * 0.7);
    points.push_back(scale * Vector3d(-half.x(), 0, half.z()) * 0.7);
  }
  for (const Vector3d& p : points) {
    EXPECT_NEAR(SignedDistance(shape(), p), DistanceBySearch(shape(), p), 1e-8)
        << "at " << p.transpose();
  }
}

TEST_P(EveryShape, IsNegativeExactlyInside) {
  int inside = 0;
  for (const Vector3d& p : Points(4000)) {
    inside += IsInside(shape(), p);
    EXPECT_EQ(SignedDistance(shape(), p) < 0, IsInside(shape(), p)) << "at " << p.transpose();
  }
  EXPECT_GT(inside, 100);
}

TEST_P(EveryShape, IsZeroOnItsSurface) {
  for (const Vector3d& p : Points(500)) {
    EXPECT_NEAR(SignedDistance(shape(), SurfacePoint(shape(), p)), 0, 1e-12)
        << "towards " << p.transpose();
  }
}

// Outside a convex solid the distance is smooth and its gradient has length 1.
TEST_P(EveryShape, HasAGradientOfLengthOneOutside) {
  const double step = 1e-6 * HalfExtents(shape()).minCoeff();
  for (const Vector3d& p : Points(500)) {
    if (SignedDistance(shape(), p) < 10 * step) continue;
    Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3d h = step * Vector3d::Unit(axis);
      gradient(axis) =
          (SignedDistance(shape(), p + h) - SignedDistance(shape(), p - h)) / (2 * step);
    }
    EXPECT_NEAR(gradient.norm(), 1, 1e-6) << "at " << p.transpose();
  }
}

TEST_P(EveryShape, NeverChangesFasterThanThePointMoves) {
  const std::vector<Vector3d> points = Points(600);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double change =
        SignedDistance(shape(), points[i]) - SignedDistance(shape(), points[i + 1]);
    EXPECT_LE(std::abs(change), (points[i] - points[i + 1]).norm() + 1e-12);
  }
}

TEST_P(EveryShape, LooksTheSameFromAllEightOctants) {
  for (const Vector3d& p : Points(50)) {
    const double expected = SignedDistance(shape(), p);
    for (int signs = 0; signs < 8; ++signs) {
      const Vector3d mirror(signs & 1 ? -1 : 1, signs & 2 ? -1 : 1, signs & 4 ? -1 : 1);
      EXPECT_EQ(SignedDistance(shape(), p.cwiseProduct(mirror)), expected);
    }
  }
}

TEST_P(EveryShape, FillsItsHalfExtents) {
  const Vector3d half = HalfExtents(shape());
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d tip = half(axis) * Vector3d::Unit(axis);
    EXPECT_NEAR(SignedDistance(shape(), tip), 0, 1e-15);
    EXPECT_NEAR(SignedDistance(shape(), 1.5 * tip), half(axis) / 2, 1e-15);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, EveryShape,
    ::testing::Values(Case{"HsrBox", Box{{0.48, 0.55, 1.2}}}, Case{"FlatBox", Box{{1, 0.8, 0.02}}},
                      Case{"Sphere", Sphere{0.3}}, Case{"Capsule", Capsule{0.1, 0.5}},
                      Case{"ShortCapsule", Capsule{0.5, 0.1}}, Case{"Cylinder", Cylinder{0.2, 0.9}},
                      Case{"Disc", Cylinder{0.6, 0.1}},
                      Case{"Ellipsoid", Ellipsoid{{0.3, 0.5, 0.2}}},
                      Case{"LongEllipsoid", Ellipsoid{{2, 0.1, 0.15}}},
                      Case{"FlatEllipsoid", Ellipsoid{{0.6, 0.5, 0.02}}},
                      Case{"OblateEllipsoid", Ellipsoid{{0.4, 0.4, 0.1}}},
                      Case{"ProlateEllipsoid", Ellipsoid{{0.1, 0.1, 0.4}}},
                      Case{"RoundEllipsoid", Ellipsoid{{0.25, 0.25, 0.25}}},
                      Case{"NearlyRoundEllipsoid", Ellipsoid{{0.25, 0.25 + 1e-9, 0.25 - 1e-9}}}),
    [](const auto& test) { return test.param.name; });

TEST(Ellipsoid, WithEqualAxesIsTheSphere) {
  RandomStream random(9, "points");
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p = UniformPoint(random, 1);
    EXPECT_NEAR(SignedDistance(Ellipsoid{{0.4, 0.4, 0.4}}, p), p.norm() - 0.4, 1e-14);
  }
}

// Inside an ellipsoid and near its centre, the nearest point is the end of the shortest axis.
TEST(Ellipsoid, IsDeepestAtItsCentre) {
  for (const Vector3d& axes :
       {Vector3d(0.3, 0.5, 0.2), Vector3d(0.1, 0.1, 0.4), Vector3d(0.25, 0.25, 0.25)}) {
    EXPECT_NEAR(SignedDistance(Ellipsoid{axes}, {0, 0, 0}), -axes.minCoeff(), 1e-15);
  }
}

// On the long axis of an ellipse (a, b), a > b, the nearest point leaves the axis where
// |x| < (a^2 - b^2) / a, and lies at distance b sqrt(1 - x^2 / (a^2 - b^2)).
TEST(Ellipsoid, FollowsTheClosedFormAlongItsLongAxis) {
  const double a = 0.5, b = 0.2;
  for (const double x : {1e-12, 0.01, 0.1, 0.3, 0.41, 0.4199999}) {
    EXPECT_NEAR(SignedDistance(Ellipsoid{{a, b, 0.3}}, {x, 0, 0}),
                -b * std::sqrt(1 - x * x / (a * a - b * b)), 1e-14)
        << x;
  }
  for (const double x : {0.4200001, 0.45, 0.5, 0.7, 100.0}) {
    EXPECT_NEAR(SignedDistance(Ellipsoid{{a, b, 0.3}}, {x, 0, 0}), x - a, 1e-13) << x;
  }
}

TEST(Shape, HasTheNameThatScenariosUse) {
  EXPECT_EQ(ShapeName(Box{{1, 1, 1}}), "box");
  EXPECT_EQ(ShapeName(Sphere{1}), "sphere");
  EXPECT_EQ(ShapeName(Capsule{1, 1}), "capsule");
  EXPECT_EQ(ShapeName(Cylinder{1, 1}), "cylinder");
  EXPECT_EQ(ShapeName(Ellipsoid{{1, 1, 1}}), "ellipsoid");
  EXPECT_EQ(ShapeName(ConvexMesh{}), "convex_mesh");
}

}  // namespace
}  // namespace sidestep::shape_test
