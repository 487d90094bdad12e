#include "sidestep/sim/convex_depth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/random.h"
#include "sidestep/core/shape.h"
#include "sidestep/sim/convex_distance.h"
#include "tests/sim/small_model.h"
#include "tests/support/random_points.h"

namespace sidestep::sim {
namespace {

using Core = ConvexSolid::Core;
using Eigen::Vector3d;

constexpr double kTolerance_m = 2e-7;
constexpr double kPi = 3.14159265358979323846;

Eigen::Isometry3d At(const Pose& X) {
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = X.rotation().toRotationMatrix();
  isometry.translation() = X.translation();
  return isometry;
}

const ConvexSolid kBall{Core::kPoint, {0, 0, 0}, {}, 0.1};
const ConvexSolid kCapsule{Core::kSegment, {0, 0, 0.3}, {}, 0.1};
const ConvexSolid kBox{Core::kBox, {0.1, 0.2, 0.3}, {}, 0};
const ConvexSolid kCylinder{Core::kCylinder, {0.1, 0, 0.3}, {}, 0};
const ConvexSolid kEllipsoid{Core::kEllipsoid, {0.1, 0.2, 0.3}, {}, 0};
const ConvexSolid kPole{Core::kCylinder, {0.2, 0, 0.9}, {}, 0};
const ConvexSolid kTetrahedron{
    Core::kHull, {0, 0, 0}, {{0.2, 0, 0}, {-0.1, 0.2, 0}, {-0.1, -0.2, 0}, {0, 0, 0.4}}, 0};

double Reach(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB,
             const Vector3d& n) {
  const Vector3d n_B = X_AB.linear().transpose() * n;
  return n.dot(CoreSupport(a, n)) - n.dot(X_AB * CoreSupport(b, -n_B)) + a.radius_m + b.radius_m;
}

// The least reach over directions all around, and ever nearer to the best of them.
double BruteForceDepth(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB) {
  struct Found {
    double reach_m;
    Vector3d n;
  };
  constexpr int kDirections = 5000, kBest = 10, kAcross = 7;
  std::vector<Found> found;
  for (int i = 0; i < kDirections; ++i) {  // a spiral from pole to pole
    const double z = 1 - (2 * i + 1.0) / kDirections, turn = i * kPi * (3 - std::sqrt(5.0));
    const double across = std::sqrt(1 - z * z);
    const Vector3d n(across * std::cos(turn), across * std::sin(turn), z);
    found.push_back({Reach(a, b, X_AB, n), n});
  }
  std::sort(found.begin(), found.end(),
            [](const Found& p, const Found& q) { return p.reach_m < q.reach_m; });
  double least = found[0].reach_m;
  for (int i = 0; i < kBest; ++i) {
    Found best = found[static_cast<std::size_t>(i)];
    for (double spread = 0.06; spread > 1e-7; spread *= 0.6) {
      const Vector3d centre = best.n, u = centre.unitOrthogonal(), v = centre.cross(u);
      for (int j = -kAcross; j <= kAcross; ++j) {
        for (int k = -kAcross; k <= kAcross; ++k) {
          const Vector3d n = (centre + spread / kAcross * (j * u + k * v)).normalized();
          const double reach = Reach(a, b, X_AB, n);
          if (reach < best.reach_m) best = {reach, n};
        }
      }
    }
    least = std::min(least, best.reach_m);
  }
  return std::max(0.0, least);
}

struct Case {
  const char* name;
  ConvexSolid a, b;
  Pose X_AB;
  double depth_m;
};
std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }

Pose Shifted(const Vector3d& p) { return Pose::Translation(p); }
Pose Turned(const Vector3d& rpy_rad, const Vector3d& p) {
  return Pose::FromRollPitchYaw(rpy_rad, p);
}

const Case kCases[] = {
    {"BallsShallow", kBall, kBall, Shifted({0.15, 0, 0}), 0.05},
    {"BallsInOnePlace", kBall, kBall, Pose(), 0.2},
    {"BallBesideAFace", kBox, kBall, Shifted({0.15, 0.05, 0}), 0.05},
    {"BallWithItsCentreOnAFace", kBox, kBall, Shifted({0.1, 0.05, 0}), 0.1},
    {"BallDeepInABox", kBox, kBall, Shifted({0.04, 0, 0.1}), 0.16},
    {"BallInTheMiddleOfABox", kBox, kBall, Pose(), 0.2},
    {"BallAtAnEdge", kBox, kBall, Shifted({0.13, 0.24, 0}), 0.05},
    {"BallApart", kBox, kBall, Shifted({0.25, 0, 0}), 0},
    {"BoxesFaceToFace", kBox, kBox, Shifted({0.15, 0.3, 0.1}), 0.05},
    {"BoxesInOnePlace", kBox, kBox, Pose(), 0.2},
    {"BoxOnTopOfAnother", kBox, kBox, Turned({0, 0, kPi / 4}, {0, 0.1, 0.55}), 0.05},
    {"BoxesApart", kBox, kBox, Shifted({0.2, 0.5, 0}), 0},
    {"CapsulesSideBySide", kCapsule, kCapsule, Shifted({0.12, 0, 0.1}), 0.08},
    {"CapsulesCrossed", kCapsule, kCapsule, Turned({kPi / 2, 0, 0}, {0.12, 0, 0}), 0.08},
    {"CapsulesCrossedThroughEachOther", kCapsule, kCapsule, Turned({kPi / 2, 0, 0}, {0, 0, 0}),
     0.2},
    {"CapsulesInOnePlace", kCapsule, kCapsule, Pose(), 0.2},
    {"CapsulesInLine", kCapsule, kCapsule, Shifted({0, 0, 0.75}), 0.05},
    {"CapsuleInABox", kBox, kCapsule, Shifted({0.03, 0, 0}), 0.17},
    {"BallInACylinder", kCylinder, kBall, Shifted({0.03, 0.04, 0}), 0.15},
    {"BallInACylinderNearItsEnd", kCylinder, kBall, Shifted({0.01, 0, 0.28}), 0.12},
    {"CylindersSideBySide", kCylinder, kCylinder, Shifted({0.09, 0.12, 0.1}), 0.05},
    {"CylindersInLine", kCylinder, kCylinder, Shifted({0, 0, 0.55}), 0.05},
    {"CylindersInOnePlace", kCylinder, kCylinder, Pose(), 0.2},
    {"CapsuleAcrossAPole", kPole, kCapsule, Turned({kPi / 2, 0, 0}, {0.25, 0, 0}), 0.05},
    {"CapsuleThroughAPole", kPole, kCapsule, Turned({kPi / 2, 0, 0}, {0.05, 0, 0}), 0.25},
    {"EllipsoidsInLine", kEllipsoid, kEllipsoid, Shifted({0.15, 0, 0}), 0.05},
    {"EllipsoidsInOnePlace", kEllipsoid, kEllipsoid, Pose(), 0.2},
    {"BallUnderATetrahedron", kTetrahedron, kBall, Shifted({0, 0, -0.06}), 0.04},
    {"BallInATetrahedron", kTetrahedron, kBall, Shifted({0, 0, 0.01}), 0.11},
};

class ClosedForm : public ::testing::TestWithParam<Case> {};

TEST_P(ClosedForm, IsTheDepthFromEitherSideAndFromElsewhere) {
  const Case& c = GetParam();
  EXPECT_NEAR(ConvexDepth(c.a, c.b, At(c.X_AB)), c.depth_m, kTolerance_m);
  EXPECT_NEAR(ConvexDepth(c.b, c.a, At(c.X_AB.Inverse())), c.depth_m, kTolerance_m);
}

INSTANTIATE_TEST_SUITE_P(ConvexDepth, ClosedForm, ::testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.name); });

struct Pair {
  const char* name;
  ConvexSolid a, b;
};
std::ostream& operator<<(std::ostream& stream, const Pair& pair) { return stream << pair.name; }

const Pair kPairs[] = {
    {"BoxBox", kBox, kBox},
    {"BoxCapsule", kBox, kCapsule},
    {"BoxCylinder", kBox, kCylinder},
    {"BoxEllipsoid", kBox, kEllipsoid},
    {"CapsuleCapsule", kCapsule, kCapsule},
    {"PoleCapsule", kPole, kCapsule},
    {"PoleBox", kPole, kBox},
    {"CylinderCylinder", kCylinder, kCylinder},
    {"CylinderEllipsoid", kCylinder, kEllipsoid},
    {"EllipsoidEllipsoid", kEllipsoid, kEllipsoid},
    {"BallEllipsoid", kBall, kEllipsoid},
    {"HullBox", kTetrahedron, kBox},
    {"HullCylinder", kTetrahedron, kCylinder},
    {"HullCapsule", kTetrahedron, kCapsule},
};

class EveryPair : public ::testing::TestWithParam<Pair> {};

TEST_P(EveryPair, IsAsDeepAsTheBestOfManyDirectionsSays) {
  const auto& [name, a, b] = GetParam();
  RandomStream generator(7, "poses");
  int num_overlapping = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const Eigen::Isometry3d X_AB = At(RandomPose(generator, 0.25));
    const double depth = ConvexDepth(a, b, X_AB);
    const double brute_force = BruteForceDepth(a, b, X_AB);
    EXPECT_LE(depth, brute_force + kTolerance_m);
    EXPECT_NEAR(depth, brute_force, 2e-5);  // the brute force is the coarser one
    if (depth == 0) continue;
    ++num_overlapping;
    EXPECT_NEAR(ConvexDepth(b, a, X_AB.inverse()), depth, kTolerance_m);
    for (int i = 0; i < 20; ++i) {  // less far, nowhere do they come apart
      Eigen::Isometry3d shifted = X_AB;
      shifted.translation() += (depth - 1e-6) * RandomPose(generator, 1).translation().normalized();
      EXPECT_EQ(ConvexDistance(a, b, shifted), 0);
    }
  }
  EXPECT_GT(num_overlapping, 15);
}

// The depth of points that move at most `step` is off by no more, also when contact begins and
// ends and when one solid passes right through the other.
TEST_P(EveryPair, ChangesNoFasterThanTheSolidsMove) {
  const auto& [name, a, b] = GetParam();
  constexpr double kStep_m = 0.001;
  RandomStream generator(5, "poses");
  for (int motion = 0; motion < 4; ++motion) {
    const Pose X_AB = motion == 0 ? Pose() : RandomPose(generator, 0.1);
    const Vector3d way = motion == 0
                             ? Vector3d(1, 0, 0)
                             : Vector3d(RandomPose(generator, 1).translation().normalized());
    double before = 0, deepest = 0;
    for (int i = -1500; i <= 1500; ++i) {
      Eigen::Isometry3d X = At(X_AB);
      X.translation() += i * kStep_m * way;
      const double depth = ConvexDepth(a, b, X);
      ASSERT_LE(std::abs(depth - before), kStep_m + 2 * kTolerance_m) << motion << " " << i;
      if (depth > 0) {
        ASSERT_EQ(ConvexDistance(a, b, X), 0);
      }
      before = depth;
      deepest = std::max(deepest, depth);
    }
    EXPECT_EQ(before, 0);
    EXPECT_GT(deepest, 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(ConvexDepth, EveryPair, ::testing::ValuesIn(kPairs),
                         [](const auto& test) { return std::string(test.param.name); });

// The axes that can separate two boxes: their normals and the products of their edges.
double BoxDepth(const Vector3d& half_a, const Vector3d& half_b, const Eigen::Isometry3d& X_AB) {
  const Eigen::Matrix3d R = X_AB.linear();
  double least = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vector3d& axis) {
    if (axis.norm() < 1e-9) return;
    const Vector3d n = axis.normalized();
    const double reach = n.cwiseAbs().dot(half_a) + (R.transpose() * n).cwiseAbs().dot(half_b);
    least = std::min(least, reach - std::abs(n.dot(X_AB.translation())));
  };
  for (int i = 0; i < 3; ++i) {
    look(Vector3d::Unit(i));
    look(R.col(i));
    for (int j = 0; j < 3; ++j) look(Vector3d::Unit(i).cross(R.col(j)));
  }
  return std::max(0.0, least);
}

TEST(ConvexDepth, OfTwoBoxesIsThatAlongTheBestOfTheirFifteenAxes) {
  RandomStream generator(3, "poses");
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Isometry3d X_AB = At(RandomPose(generator, 0.3));
    EXPECT_NEAR(ConvexDepth(kBox, kBox, X_AB), BoxDepth(kBox.size_m, kBox.size_m, X_AB),
                kTolerance_m);
  }
}

TEST(ConvexDepth, OfABallIsItsRadiusLessTheSignedDistanceOfItsCentre) {
  const std::pair<ConvexSolid, Shape> solids[] = {{kBox, Box{{0.2, 0.4, 0.6}}},
                                                  {kCapsule, Capsule{0.1, 0.6}},
                                                  {kCylinder, Cylinder{0.1, 0.6}},
                                                  {kEllipsoid, Ellipsoid{{0.1, 0.2, 0.3}}}};
  RandomStream generator(2, "poses");
  for (const auto& [solid, shape] : solids) {
    for (int trial = 0; trial < 300; ++trial) {
      const Pose X_AB = RandomPose(generator, 0.3);
      const double wanted = 0.1 - SignedDistance(shape, X_AB.translation());
      EXPECT_NEAR(ConvexDepth(solid, kBall, At(X_AB)), std::max(0.0, wanted), kTolerance_m);
    }
  }
}

}  // namespace
}  // namespace sidestep::sim
