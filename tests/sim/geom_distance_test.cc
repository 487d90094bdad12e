#include "sidestep/sim/geom_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include "sidestep/core/shape.h"
#include "tests/sim/small_model.h"
#include "tests/support/random_points.h"

namespace sidestep::sim::geom_distance_test {
namespace {

using Eigen::Vector3d;

constexpr double kTolerance_m = 3e-9;

// Two geoms in mocap bodies 0 and 1.
SmallModel TwoGeoms(const std::string& geom1, const std::string& geom2,
                    const std::string& asset = "") {
  return SmallModel("<body mocap='true'><geom " + geom1 + "/></body><body mocap='true'><geom " +
                        geom2 + "/></body>",
                    "<asset>" + asset + "</asset>");
}

// The least distance from the segment between two points of A to a solid in B. Along a segment the
// distance to a convex solid is convex, so golden sections find its minimum.
double SegmentDistance(const Vector3d& p_A, const Vector3d& q_A, const Pose& X_BA,
                       const Shape& shape) {
  const auto at = [&](double s) { return SignedDistance(shape, X_BA * (p_A + s * (q_A - p_A))); };
  const double golden = (std::sqrt(5.0) - 1) / 2;
  double low = 0, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (at(a) < at(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return at((low + high) / 2);
}

double CapsuleDistance(const Capsule& capsule, const Pose& X_WA, const Pose& X_WB,
                       const Shape& shape) {
  const Vector3d end(0, 0, capsule.length_m / 2);
  return SegmentDistance(-end, end, X_WB.Inverse() * X_WA, shape) - capsule.radius_m;
}

double SphereDistance(double radius_m, const Pose& X_WA, const Pose& X_WB, const Shape& shape) {
  return SignedDistance(shape, X_WB.Inverse() * X_WA.translation()) - radius_m;
}

Vector3d Corner(const Vector3d& half, unsigned index) {
  return {(index & 1u) != 0 ? half.x() : -half.x(), (index & 2u) != 0 ? half.y() : -half.y(),
          (index & 4u) != 0 ? half.z() : -half.z()};
}

// Wherever two boxes are nearest or overlap, an edge of one of them takes part.
double BoxDistance(const Vector3d& half_a, const Pose& X_WA, const Vector3d& half_b,
                   const Pose& X_WB) {
  const auto edges_of_first = [](const Vector3d& half1, const Pose& X_W1, const Vector3d& half2,
                                 const Pose& X_W2) {
    double least = std::numeric_limits<double>::infinity();
    for (unsigned corner = 0; corner < 8; ++corner) {
      for (const unsigned along : {1u, 2u, 4u}) {
        if ((corner & along) != 0) continue;
        least =
            std::min(least, SegmentDistance(Corner(half1, corner), Corner(half1, corner | along),
                                            X_W2.Inverse() * X_W1, Box{2 * half2}));
      }
    }
    return least;
  };
  return std::min(edges_of_first(half_a, X_WA, half_b, X_WB),
                  edges_of_first(half_b, X_WB, half_a, X_WA));
}

double BoxOverPlane(const Vector3d& half, const Pose& X_WA, const Pose& X_WPlane) {
  double least = std::numeric_limits<double>::infinity();
  for (unsigned corner = 0; corner < 8; ++corner) {
    least = std::min(least, (X_WPlane.Inverse() * (X_WA * Corner(half, corner))).z());
  }
  return least;
}

double CylinderOverPlane(const Cylinder& cylinder, const Pose& X_WA, const Pose& X_WPlane) {
  const Pose X_PA = X_WPlane.Inverse() * X_WA;
  constexpr int kPoints = 20000;  // of each rim: within 1.3 nm of the lowest point
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kPoints; ++i) {
    const double angle = i * 2 * 3.14159265358979323846 / kPoints;
    const double x = cylinder.radius_m * std::cos(angle), y = cylinder.radius_m * std::sin(angle);
    for (const double z : {-cylinder.length_m / 2, cylinder.length_m / 2}) {
      least = std::min(least, (X_PA * Vector3d(x, y, z)).z());
    }
  }
  return least;
}

struct Case {
  const char* name;
  const char *geom1, *geom2;
  std::function<double(const Pose&, const Pose&)> distance;  ///< of X_W1, X_W2; negative: overlap
  bool tells_depth = false;                                  ///< where it is negative
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const Vector3d kHalf(0.1, 0.2, 0.3);
const Shape kBox = Box{{0.2, 0.4, 0.6}};
const Shape kCylinder = Cylinder{0.1, 0.6};
const Shape kEllipsoid = Ellipsoid{{0.1, 0.2, 0.3}};
constexpr Capsule kCapsule{0.1, 0.6};

const char* const kSphereGeom = "type='sphere' size='0.1'";
const char* const kCapsuleGeom = "type='capsule' size='0.1 0.3'";
const char* const kBoxGeom = "type='box' size='0.1 0.2 0.3'";
const char* const kCylinderGeom = "type='cylinder' size='0.1 0.3'";
const char* const kEllipsoidGeom = "type='ellipsoid' size='0.1 0.2 0.3'";
const char* const kPlaneGeom = "type='plane' size='0 0 1'";

const Case kCases[] = {
    {"SphereSphere", kSphereGeom, kSphereGeom,
     [](const Pose& a, const Pose& b) { return SphereDistance(0.1, a, b, Sphere{0.1}); }, true},
    {"SphereBox", kSphereGeom, kBoxGeom,
     [](const Pose& a, const Pose& b) { return SphereDistance(0.1, a, b, kBox); }, true},
    {"SphereCylinder", kSphereGeom, kCylinderGeom,
     [](const Pose& a, const Pose& b) { return SphereDistance(0.1, a, b, kCylinder); }, true},
    {"SphereEllipsoid", kSphereGeom, kEllipsoidGeom,
     [](const Pose& a, const Pose& b) { return SphereDistance(0.1, a, b, kEllipsoid); }, true},
    {"CapsuleCapsule", kCapsuleGeom, kCapsuleGeom,
     [](const Pose& a, const Pose& b) { return CapsuleDistance(kCapsule, a, b, kCapsule); }},
    {"CapsuleBox", kCapsuleGeom, kBoxGeom,
     [](const Pose& a, const Pose& b) { return CapsuleDistance(kCapsule, a, b, kBox); }},
    {"CapsuleCylinder", kCapsuleGeom, kCylinderGeom,
     [](const Pose& a, const Pose& b) { return CapsuleDistance(kCapsule, a, b, kCylinder); }},
    {"CapsuleEllipsoid", kCapsuleGeom, kEllipsoidGeom,
     [](const Pose& a, const Pose& b) { return CapsuleDistance(kCapsule, a, b, kEllipsoid); }},
    {"BoxBox", kBoxGeom, kBoxGeom,
     [](const Pose& a, const Pose& b) { return BoxDistance(kHalf, a, kHalf, b); }},
    {"SpherePlane", kSphereGeom, kPlaneGeom,
     [](const Pose& a, const Pose& b) { return (b.Inverse() * a.translation()).z() - 0.1; }, true},
    {"CapsulePlane", kCapsuleGeom, kPlaneGeom,
     [](const Pose& a, const Pose& b) {
       const Pose X_BA = b.Inverse() * a;
       return std::min((X_BA * Vector3d(0, 0, 0.3)).z(), (X_BA * Vector3d(0, 0, -0.3)).z()) - 0.1;
     },
     true},
    {"BoxPlane", kBoxGeom, kPlaneGeom,
     [](const Pose& a, const Pose& b) { return BoxOverPlane(kHalf, a, b); }, true},
    {"CylinderPlane", kCylinderGeom, kPlaneGeom,
     [](const Pose& a, const Pose& b) {
       return CylinderOverPlane({0.1, 0.6}, a, b);
     },
     true},
    {"EllipsoidPlane", kEllipsoidGeom, kPlaneGeom,
     [](const Pose& a, const Pose& b) {
       // Its lowest point is where the gradient of (x/a)^2 + (y/b)^2 + (z/c)^2 is against the
       // normal.
       const Vector3d n = a.RotateInverse(b.Rotate(Vector3d::UnitZ()));
       const Vector3d along = kHalf.cwiseProduct(kHalf).cwiseProduct(n);
       return (b.Inverse() * (a * (-along / std::sqrt(along.dot(n))))).z();
     },
     true},
};

class EveryPair : public testing::TestWithParam<Case> {};

TEST_P(EveryPair, IsAsFarApartAsTheClosedFormSays) {
  SmallModel m = TwoGeoms(GetParam().geom1, GetParam().geom2);
  const GeomDistance distance(*m.model);
  RandomStream random(11, "poses");
  int num_apart = 0, num_overlapping = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Pose X_W1 = RandomPose(random, 0.6), X_W2 = RandomPose(random, 0.6);
    m.Place(0, X_W1);
    m.Place(1, X_W2);
    const double wanted = GetParam().distance(X_W1, X_W2);
    EXPECT_NEAR(distance.Distance(*m.data, 0, 1), std::max(0.0, wanted), kTolerance_m);
    EXPECT_NEAR(distance.Distance(*m.data, 1, 0), std::max(0.0, wanted), kTolerance_m);
    EXPECT_LE(distance.LowerBound(*m.data, 0, 1), std::max(0.0, wanted) + 1e-12);
    EXPECT_EQ(distance.Depth(*m.data, 0, 1) > 1e-6, wanted < -1e-6) << wanted;
    if (GetParam().tells_depth) {
      EXPECT_NEAR(distance.Depth(*m.data, 0, 1), std::max(0.0, -wanted), 2e-7);
      EXPECT_NEAR(distance.Depth(*m.data, 1, 0), std::max(0.0, -wanted), 2e-7);
    }
    if (std::abs(wanted) > 1e-5) {
      EXPECT_EQ(FindTouch(*m.model, *m.data, 0, 1).has_value(), wanted < 0) << wanted;
      EXPECT_EQ(FindTouch(*m.model, *m.data, 1, 0).has_value(), wanted < 0) << wanted;
    }
    (wanted > 0 ? num_apart : num_overlapping)++;
  }
  EXPECT_GT(num_apart, 20);
  EXPECT_GT(num_overlapping, 2);
}

INSTANTIATE_TEST_SUITE_P(GeomDistance, EveryPair, testing::ValuesIn(kCases),
                         [](const auto& test) { return test.param.name; });

// Pairs whose nearest features are parallel, or meet at right angles: the general algorithms'
// stumbling blocks.
struct AlignedCase {
  const char* name;
  const char *geom1, *geom2;
  Vector3d rpy1_rad, rpy2_rad, p_12;  ///< the first is at the origin
  double distance_m;
};
void PrintTo(const AlignedCase& c, std::ostream* out) { *out << c.name; }

constexpr double kEighth = 3.14159265358979323846 / 4;  // of a turn
const char* const kCube = "type='box' size='0.1 0.1 0.1'";

const AlignedCase kAlignedCases[] = {
    {"FaceToFace", kCube, kCube, {0, 0, 0}, {0, 0, 0}, {0.5, 0.05, -0.03}, 0.3},
    {"FaceToSameFace", kCube, kCube, {0, 0, 0}, {0, 0, 0}, {0.5, 0, 0}, 0.3},
    {"ParallelEdges", kCube, kCube, {0, 0, 0}, {0, 0, 0}, {0.5, 0.6, 0}, 0.5},
    {"CornerToCorner", kCube, kCube, {0, 0, 0}, {0, 0, 0}, {0.4, 0.4, 0.4}, 0.2 * std::sqrt(3.0)},
    {"EdgeToFace",
     kCube,
     kCube,
     {0, 0, kEighth},
     {0, 0, 0},
     {0.5, 0, 0},
     0.4 - 0.1 * std::sqrt(2.0)},
    {"EdgeAcrossEdge",
     kCube,
     kCube,
     {0, kEighth, 0},
     {0, 0, kEighth},
     {0.6, 0, 0},
     0.6 - 0.2 * std::sqrt(2.0)},
    {"Overlapping", kCube, kCube, {0, 0, 0}, {0, 0, 0.3}, {0.15, 0, 0}, 0},
    {"Same", kCube, kCube, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, 0},
    {"CylinderAlongFace", kBoxGeom, kCylinderGeom, {0, 0, 0}, {0, 0, 0}, {0.5, 0, 0}, 0.3},
    {"CylinderOnTop", kBoxGeom, kCylinderGeom, {0, 0, 0}, {0, 0, 0}, {0, 0, 0.9}, 0.3},
    {"CylindersSideBySide", kCylinderGeom, kCylinderGeom, {0, 0, 0}, {0, 0, 0}, {0.5, 0, 0.1}, 0.3},
    {"CylindersInLine", kCylinderGeom, kCylinderGeom, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}, 0.4},
    {"CylindersCrossed",
     kCylinderGeom,
     kCylinderGeom,
     {0, 0, 0},
     {2 * kEighth, 0, 0},
     {0.5, 0, 0},
     0.3},
    {"EllipsoidsInLine", kEllipsoidGeom, kEllipsoidGeom, {0, 0, 0}, {0, 0, 0}, {0.5, 0, 0}, 0.3},
    {"CapsulesSideBySide", kCapsuleGeom, kCapsuleGeom, {0, 0, 0}, {0, 0, 0}, {0.5, 0, 0}, 0.3},
    {"CapsulesCrossed",
     kCapsuleGeom,
     kCapsuleGeom,
     {0, 0, 0},
     {2 * kEighth, 0, 0},
     {0.5, 0, 0},
     0.3},
};

class AlignedPair : public testing::TestWithParam<AlignedCase> {};

TEST_P(AlignedPair, IsAsFarApartAsItsNearestFeatures) {
  const AlignedCase& c = GetParam();
  SmallModel m = TwoGeoms(c.geom1, c.geom2);
  const GeomDistance distance(*m.model);
  RandomStream random(3, "poses");
  for (int trial = 0; trial < 20; ++trial) {  // the same pair, seen from elsewhere
    const Pose X_WA = trial == 0 ? Pose() : RandomPose(random, 0.5);
    m.Place(0, X_WA * Pose::FromRollPitchYaw(c.rpy1_rad, {0, 0, 0}));
    m.Place(1, X_WA * Pose::FromRollPitchYaw(c.rpy2_rad, c.p_12));
    EXPECT_NEAR(distance.Distance(*m.data, 0, 1), c.distance_m, kTolerance_m);
    EXPECT_NEAR(distance.Distance(*m.data, 1, 0), c.distance_m, kTolerance_m);
  }
}

INSTANTIATE_TEST_SUITE_P(GeomDistance, AlignedPair, testing::ValuesIn(kAlignedCases),
                         [](const auto& test) { return test.param.name; });

TEST(GeomDistance, TakesAMeshForItsConvexHull) {
  // A box as a mesh, with one more vertex inside.
  const std::string mesh =
      "<mesh name='m' vertex='-0.1 -0.2 -0.3  0.1 -0.2 -0.3  -0.1 0.2 -0.3  0.1 0.2 -0.3  "
      "-0.1 -0.2 0.3  0.1 -0.2 0.3  -0.1 0.2 0.3  0.1 0.2 0.3  0 0 0.1'/>";
  for (const char* other : {"type='sphere' size='0.1'", "type='plane' size='0 0 1'"}) {
    SmallModel m = TwoGeoms("type='mesh' mesh='m'", other, mesh);
    SmallModel box = TwoGeoms("type='box' size='0.1 0.2 0.3'", other);
    const GeomDistance distance(*m.model), box_distance(*box.model);
    RandomStream random(5, "poses");
    for (int trial = 0; trial < 50; ++trial) {
      for (int body = 0; body < 2; ++body) {
        const Pose X_WO = RandomPose(random, 0.7);
        m.Place(body, X_WO);
        box.Place(body, X_WO);
      }
      EXPECT_NEAR(distance.Distance(*m.data, 0, 1), box_distance.Distance(*box.data, 0, 1),
                  1e-7);  // its vertices are of single precision
    }
  }
}

TEST(GeomDistance, MeasuresToAMeshThatLiesFarFromItsFrame) {
  // A cube 20 m from the origin of the mesh's own file, and its geom moved once more.
  std::string mesh = "<mesh name='m' vertex='";
  for (const char* x : {"19.9 ", "20.1 "}) {
    for (const char* y : {"-0.1 ", "0.1 "}) {
      for (const char* z : {"-0.1 ", "0.1 "}) mesh += std::string(x) + y + z;
    }
  }
  mesh += "'/>";
  for (const char* other : {"type='sphere' size='0.1'", "type='box' size='0.1 0.1 0.1'"}) {
    SmallModel m = TwoGeoms("type='mesh' mesh='m' pos='0 0 0.3'", other, mesh);
    const GeomDistance distance(*m.model);
    for (const double x : {-1.0, 0.0, 19.5, 20.5, 30.0}) {
      m.Place(1, Pose::Translation({x, 0, 0.3}));
      EXPECT_NEAR(distance.Distance(*m.data, 0, 1), std::abs(x - 20) - 0.2, 1e-5) << x;
      EXPECT_LE(distance.LowerBound(*m.data, 0, 1), std::abs(x - 20) - 0.2 + 1e-5) << x;
    }
  }
  SmallModel m = TwoGeoms("type='mesh' mesh='m'", "type='plane' size='0 0 1'", mesh);
  const GeomDistance distance(*m.model);
  m.Place(1, Pose(Eigen::Quaterniond(Eigen::AngleAxisd(kEighth * 2, Vector3d::UnitY())),
                  {5, 0, 0}));  // looks along x
  EXPECT_NEAR(distance.Distance(*m.data, 0, 1), 14.9, 1e-5);
}

TEST(GeomDistance, MeasuresToTheTrianglesOfAHeightField) {
  // A ramp of slope 1/2 along x, 2 m long and wide; below it the base.
  SmallModel m = TwoGeoms("type='sphere' size='0.1'", "type='hfield' hfield='h'",
                          "<hfield name='h' nrow='3' ncol='5' size='1 1 1 0.1'/>");
  for (int i = 0; i < 15; ++i) m.model->hfield_data[i] = static_cast<float>(i % 5) / 4;
  const GeomDistance distance(*m.model);
  const Vector3d normal = Vector3d(-0.5, 0, 1).normalized();
  for (const double away : {0.11, 0.2, 0.5}) {
    for (const double x : {-0.37, 0.0, 0.21}) {
      m.Place(0, Pose::Translation(Vector3d(x, 0.3, (x + 1) / 2) + away * normal));
      EXPECT_NEAR(distance.Distance(*m.data, 0, 1), away - 0.1, kTolerance_m);
      EXPECT_FALSE(FindTouch(*m.model, *m.data, 0, 1).has_value());
    }
  }
  m.Place(0, Pose::Translation({0.2, 0, -0.3}));  // under it
  EXPECT_NEAR(distance.Distance(*m.data, 0, 1), 0.1, kTolerance_m);
  m.Place(0, Pose::Translation({1.3, 0.5, 0.4}));  // beside its high end
  EXPECT_NEAR(distance.Distance(*m.data, 0, 1), 0.2, kTolerance_m);
  // Far beside its corner, on the far side of the frame for most of its prisms.
  m.Place(0, Pose::Translation({-9, 0.3, -0.05}));
  EXPECT_NEAR(distance.Distance(*m.data, 0, 1), 7.9, kTolerance_m);
  m.Place(0, Pose::Translation({0, 0, 0.45}));
  EXPECT_NEAR(distance.Distance(*m.data, 0, 1), 0, kTolerance_m);
  EXPECT_TRUE(FindTouch(*m.model, *m.data, 0, 1).has_value());
  m.Place(0, Pose::Translation(Vector3d(0, 0.3, 0.5) + 0.04 * normal));
  EXPECT_NEAR(distance.Depth(*m.data, 0, 1), 0.06, 2e-7);
}

TEST(GeomDistance, SaysHowDeepAndWhereTwoSolidsTouch) {
  SmallModel m = TwoGeoms("type='sphere' size='0.1'", "type='box' size='0.2 0.2 0.2'");
  m.Place(0, Pose::Translation({0.27, 0.05, 0}));
  const auto touch = FindTouch(*m.model, *m.data, 0, 1);
  ASSERT_TRUE(touch.has_value());
  EXPECT_NEAR(touch->depth_m, 0.03, 1e-9);
  EXPECT_LT((touch->p_WContact - Vector3d(0.185, 0.05, 0)).norm(), 1e-9);
}

}  // namespace
}  // namespace sidestep::sim::geom_distance_test
