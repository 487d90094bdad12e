// The parts that covers are made and judged with: meshes around shapes, volumes, what sticks out.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <ostream>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/import/closed_mesh.h"
#include "sidestep/import/outer_mesh.h"
#include "sidestep/import/solid_cells.h"
#include "sidestep/import/sphere_union.h"
#include "sidestep/import/uncovered.h"
#include "tests/import/sample_meshes.h"
#include "tests/support/random_points.h"

namespace sidestep::imports::solid_geometry_test {
namespace {

constexpr double kPi = std::numbers::pi;

struct ShapeCase {
  const char* name;
  Shape shape;
  double volume_m3;
};
std::ostream& operator<<(std::ostream& out, const ShapeCase& one) { return out << one.name; }

class OuterMeshOf : public ::testing::TestWithParam<ShapeCase> {};

TEST_P(OuterMeshOf, IsClosedAroundItAndWithinTheTolerance) {
  RandomStream random(1, "outer mesh");
  const Pose X_WO = RandomPose(random, 1);
  for (const double tolerance_m : {0.01, 0.001}) {
    const TriangleMesh mesh = OuterMesh({GetParam().shape, X_WO}, tolerance_m);
    CheckClosed({"it", mesh});
    // It is convex, so that its corners are what is furthest outside ...
    const Pose X_OW = X_WO.Inverse();
    for (const auto& p : mesh.vertices.colwise()) {
      EXPECT_LE(SignedDistance(GetParam().shape, X_OW * p), tolerance_m + 1e-12);
    }
    // ... and the shape is inside if it is behind each facet.
    for (const auto& triangle : mesh.triangles.colwise()) {
      const Eigen::Vector3d a = mesh.vertices.col(triangle[0]), b = mesh.vertices.col(triangle[1]),
                            c = mesh.vertices.col(triangle[2]);
      const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
      for (const double share : {0.2, 0.3, 0.5}) {
        const Eigen::Vector3d p = share * a + 0.3 * b + (0.7 - share) * c + 1e-9 * normal;
        EXPECT_GE(SignedDistance(GetParam().shape, X_OW * p), -1e-12);
      }
    }
  }
}

TEST_P(OuterMeshOf, HasItsVolume) {
  RandomStream random(2, "outer mesh");
  const TriangleMesh mesh = OuterMesh({GetParam().shape, RandomPose(random, 1)}, 1e-5);
  EXPECT_NEAR(SignedVolume_m3(mesh), GetParam().volume_m3, 1e-3 * GetParam().volume_m3);
  const SolidCells cells = FillCells({mesh}, 100);
  EXPECT_NEAR(cells.volume_m3, GetParam().volume_m3, 3e-3 * GetParam().volume_m3);
  const double cell_m3 = std::pow(cells.grid.spec.cell_m, 3);
  EXPECT_NEAR(static_cast<double>(cells.grid.CountFilled()) * cell_m3, GetParam().volume_m3,
              0.02 * GetParam().volume_m3);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, OuterMeshOf,
    ::testing::Values(ShapeCase{"box", Box{{0.1, 0.2, 0.3}}, 0.006},
                      ShapeCase{"sphere", Sphere{0.1}, 4 * kPi / 3 * 1e-3},
                      ShapeCase{"cylinder", Cylinder{0.1, 0.3}, kPi * 3e-3},
                      ShapeCase{"capsule", Capsule{0.1, 0.3}, kPi * 3e-3 + 4 * kPi / 3 * 1e-3},
                      ShapeCase{"ellipsoid", Ellipsoid{{0.1, 0.2, 0.05}}, 4 * kPi / 3 * 1e-3}),
    [](const auto& test) { return test.param.name; });

std::string Complaint(TriangleMesh mesh) {
  try {
    CheckClosed({"arm.stl", std::move(mesh)});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckClosed, NamesTheMeshAndWhatIsWrongWithIt) {
  const TriangleMesh box = OuterMesh({Box{{2, 2, 2}}, Pose()}, 0.1);
  EXPECT_EQ(Complaint(box), "");
  TriangleMesh open = box;
  open.triangles = box.triangles.leftCols(11);
  EXPECT_EQ(Complaint(open),
            "arm.stl: is not closed: the edge from (1, -1, -1) to (1, -1, 1) has a triangle on one "
            "side only");
  TriangleMesh turned = box;
  turned.triangles.col(0).head<2>().reverseInPlace();
  EXPECT_THAT(Complaint(turned), ::testing::HasSubstr("triangles that do not face the same way"));
  TriangleMesh inside_out = box;
  inside_out.triangles.row(1).swap(inside_out.triangles.row(2));
  EXPECT_EQ(Complaint(inside_out), "arm.stl: is inside out, or holds no volume");
  TriangleMesh wrong = box;
  wrong.triangles(0, 0) = 8;
  EXPECT_EQ(Complaint(wrong), "arm.stl: has a triangle with a corner that is no vertex");
  TriangleMesh infinite = box;
  infinite.vertices(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Complaint(infinite), "arm.stl: has a vertex that is not finite");
  EXPECT_EQ(Complaint({}), "arm.stl: has no triangles");
}

TEST(CheckClosed, TakesLooseTrianglesWhoseCornersMeet) {
  const TriangleMesh box = OuterMesh({Box{{2, 2, 2}}, Pose()}, 0.1);
  TriangleMesh loose;
  loose.vertices.resize(3, 3 * box.triangles.cols());
  loose.triangles.resize(3, box.triangles.cols());
  for (int i = 0; i < box.triangles.cols(); ++i) {
    for (int k = 0; k < 3; ++k) {
      loose.vertices.col(3 * i + k) = box.vertices.col(box.triangles(k, i));
      loose.triangles(k, i) = 3 * i + k;
    }
  }
  EXPECT_EQ(Complaint(loose), "");
}

TEST(FillCells, CountsWhatOverlapsOnceAndKeepsHolesFree) {
  const TriangleMesh low = OuterMesh({Box{{1, 1, 1}}, Pose()}, 0.1);
  const TriangleMesh high = OuterMesh({Box{{1, 1, 1}}, Pose::Translation({0, 0, 0.25})}, 0.1);
  EXPECT_NEAR(FillCells({low, high}, 100).volume_m3, 1.25, 0.01);
  const TriangleMesh ring = Ring(1, 0.25, 60);
  EXPECT_NEAR(FillCells({ring}, 200).volume_m3, SignedVolume_m3(ring), 2e-3);
}

TEST(UnionVolume, OfTwoBallsIsThatOfTheirLens) {
  const double r = 0.3, d = 0.4;
  const double ball = 4 * kPi / 3 * r * r * r;
  const double lens = kPi * (4 * r + d) * (2 * r - d) * (2 * r - d) / 12;
  RandomStream random(3, "union");
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d a = UniformPoint(random, 1);
    const Eigen::Vector3d b = a + d * UniformPoint(random, 1).normalized();
    EXPECT_NEAR(UnionVolume_m3({{a, r}, {b, r}}), 2 * ball - lens, 2e-4 * ball);
  }
}

TEST(UnionVolume, CountsEqualAndHiddenBallsOnce) {
  const double ball = 4 * kPi / 3;
  EXPECT_NEAR(UnionVolume_m3({{{0, 0, 0}, 1}, {{0, 0, 0}, 1}, {{0.1, 0, 0.2}, 0.5}}), ball, 1e-4);
  EXPECT_EQ(UnionVolume_m3({}), 0);
}

TEST(UnionVolume, IsThatOfManyBallsByCountingPoints) {
  RandomStream random(4, "union");
  std::vector<CoverSphere> spheres;
  for (int i = 0; i < 12; ++i)
    spheres.push_back({UniformPoint(random, 0.6), random.Uniform(0.1, 0.4)});
  int inside = 0;
  constexpr int kPoints = 200000;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d p = UniformPoint(random, 1);
    inside += std::any_of(spheres.begin(), spheres.end(), [&](const CoverSphere& sphere) {
      return (p - sphere.center_m).norm() < sphere.radius_m;
    });
  }
  EXPECT_NEAR(UnionVolume_m3(spheres), 8.0 * inside / kPoints, 0.03);  // 3 sigma
}

TEST(FindUncovered, OfABallInABoxIsTheWayToItsCorners) {
  const TriangleMesh box = OuterMesh({Box{{2, 4, 6}}, Pose()}, 0.1);
  const Uncovered uncovered = FindUncovered({box}, {{{0, 0, 0}, 1}}, 1e-6);
  EXPECT_NEAR(uncovered.at_most_m, std::sqrt(14.0) - 1, 1e-5);
  EXPECT_NEAR(uncovered.p_m.cwiseAbs().sum(), 6, 1e-9);
}

TEST(FindUncovered, BoundsWhatDensePointsShow) {
  for (int seed = 1; seed <= 5; ++seed) {
    RandomStream random(static_cast<std::uint64_t>(seed), "uncovered");
    const TriangleMesh mesh = BumpyBall(random, 1, 0.4);
    std::vector<CoverSphere> spheres;
    for (int i = 0; i < 8; ++i) {
      spheres.push_back({UniformPoint(random, 0.6), random.Uniform(0.3, 0.7)});
    }
    const Uncovered uncovered = FindUncovered({mesh}, spheres, 1e-4);
    double seen_m = -1;
    const Eigen::Matrix3Xd points = DensePoints(mesh, 0.02);
    for (const auto& p : points.colwise()) {
      double out_m = 1e9;
      for (const CoverSphere& sphere : spheres) {
        out_m = std::min(out_m, (p - sphere.center_m).norm() - sphere.radius_m);
      }
      seen_m = std::max(seen_m, out_m);
    }
    EXPECT_LE(uncovered.at_least_m, uncovered.at_most_m);
    EXPECT_LE(uncovered.at_most_m, uncovered.at_least_m + 1.01e-4);
    EXPECT_LE(seen_m, uncovered.at_most_m);
    EXPECT_GE(seen_m + 0.02, uncovered.at_least_m);  // points are that far apart
    // What is grown to cover it covers it, and no further.
    GrowToCover({mesh}, 0.05, 1e4, &spheres);
    const Uncovered grown = FindUncovered({mesh}, spheres, 1e-5);
    EXPECT_LE(grown.at_least_m, 0.05);
    EXPECT_GE(grown.at_most_m, 0.05 - 2e-4);
  }
}

}  // namespace
}  // namespace sidestep::imports::solid_geometry_test
