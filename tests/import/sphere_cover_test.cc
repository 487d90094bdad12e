#include "sidestep/import/sphere_cover.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/import/outer_mesh.h"
#include "tests/import/sample_meshes.h"
#include "tests/support/random_points.h"

namespace sidestep::imports {
namespace {

double OutOf(const std::vector<CoverSphere>& spheres, const Eigen::Vector3d& p) {
  double out_m = std::numeric_limits<double>::infinity();
  for (const CoverSphere& sphere : spheres) {
    out_m = std::min(out_m, (p - sphere.center_m).norm() - sphere.radius_m);
  }
  return out_m;
}

// By points on the surfaces, of shapes by those of a finer mesh around them than the cover had.
double SeenToStickOut(const LinkSolids& solids, const std::vector<CoverSphere>& spheres,
                      double cover_m, double apart_m) {
  double seen_m = -std::numeric_limits<double>::infinity();
  const auto look = [&](const TriangleMesh& mesh) {
    const Eigen::Matrix3Xd points = DensePoints(mesh, apart_m);
    for (const auto& p : points.colwise()) seen_m = std::max(seen_m, OutOf(spheres, p));
  };
  for (const PlacedShape& shape : solids.shapes) look(OuterMesh(shape, cover_m / 500));
  for (const NamedMesh& mesh : solids.meshes) look(mesh.mesh);
  return seen_m;
}

Shape RandomShape(RandomStream& random, double size_m) {
  const double a = size_m * random.Uniform(0.2, 1), b = size_m * random.Uniform(0.2, 1);
  switch (static_cast<int>(random.Uniform(0, 5))) {
    case 0:
      return Box{{a, b, size_m * random.Uniform(0.2, 1)}};
    case 1:
      return Sphere{a / 2};
    case 2:
      return Capsule{a / 3, b};
    case 3:
      return Cylinder{a / 3, b};
    default:
      return Ellipsoid{{a / 2, b / 2, size_m / 4}};
  }
}

struct SolidCase {
  const char* name;
  LinkSolids solids;
  double cover_m;
};
std::ostream& operator<<(std::ostream& out, const SolidCase& one) { return out << one.name; }

std::vector<SolidCase> SolidCases() {
  RandomStream random(1, "solids");
  std::vector<SolidCase> cases;
  cases.push_back(
      {"ConvexMesh",
       {{}, {{"m", OuterMesh({Ellipsoid{{0.3, 0.2, 0.1}}, RandomPose(random, 1)}, 0.01)}}},
       0.01});
  cases.push_back({"ConcaveMesh", {{}, {{"m", BumpyBall(random, 0.1, 0.6)}}}, 0.005});
  cases.push_back({"ConcaveMeshCoveredCoarsely", {{}, {{"m", BumpyBall(random, 0.1, 0.5)}}}, 0.03});
  cases.push_back({"Ring", {{}, {{"m", Ring(0.2, 0.05, 40)}}}, 0.01});
  for (const char* const name : {"Shapes", "OtherShapes"}) {
    LinkSolids solids;
    for (int i = 0; i < 4; ++i)
      solids.shapes.push_back({RandomShape(random, 0.2), RandomPose(random, 0.1)});
    cases.push_back({name, solids, 0.006});
  }
  LinkSolids mixed{{{Cylinder{0.05, 0.3}, RandomPose(random, 0.05)}},
                   {{"m", BumpyBall(random, 0.1, 0.3)}}};
  cases.push_back({"ShapeAndMesh", mixed, 0.005});
  cases.push_back({"ThinPlate", {{{Box{{0.3, 0.2, 0.0005}}, RandomPose(random, 1)}}, {}}, 0.01});
  cases.push_back({"ThinRod", {{{Cylinder{0.0003, 0.5}, RandomPose(random, 1)}}, {}}, 0.005});
  cases.push_back({"TinyBox", {{{Box{{1e-6, 2e-6, 3e-6}}, Pose()}}, {}}, 1e-7});
  cases.push_back({"HugeBox", {{{Box{{1e4, 2e4, 3e4}}, Pose()}}, {}}, 1e3});
  cases.push_back(
      {"FarAway", {{{Box{{0.1, 0.1, 0.2}}, Pose::Translation({1e3, 0, 0})}}, {}}, 0.005});
  return cases;
}

class EverySolid : public ::testing::TestWithParam<SolidCase> {};

TEST_P(EverySolid, SticksOutByNoMoreThanIsPromised) {
  const auto& [name, solids, cover_m] = GetParam();
  CoverRequest request;
  request.cover_m = cover_m;
  const RobotCover cover = CoverLinks({solids}, request);
  EXPECT_EQ(cover.cover_m, cover_m);
  ASSERT_EQ(cover.links.size(), 1u);
  ASSERT_FALSE(cover.links[0].spheres.empty());
  EXPECT_LE(cover.num_spheres(), kMostSpheresOfALink);
  const double apart_m = cover_m / 3;
  EXPECT_LE(SeenToStickOut(solids, cover.links[0].spheres, cover_m, apart_m), cover_m);
  // The check says so too, and not only because it is coarse.
  const CoverCheck check = CheckCover(solids, cover.links[0].spheres, cover_m / 1000);
  EXPECT_LE(check.uncovered_m, cover_m);
  EXPECT_GE(check.uncovered_m, 0.9 * cover_m) << "it could be covered with less";
  EXPECT_NEAR(check.sphere_m3, cover.links[0].sphere_m3, 1e-6 * check.sphere_m3);
}

INSTANTIATE_TEST_SUITE_P(Solids, EverySolid, ::testing::ValuesIn(SolidCases()),
                         [](const auto& test) { return test.param.name; });

LinkSolids Bar() { return {{{Cylinder{0.05, 0.25}, Pose()}}, {}}; }
LinkSolids Knob() { return {{{Sphere{0.05}, Pose::Translation({0.3, 0, 0})}}, {}}; }

TEST(CoverLinks, TakesOneBallForABallAndFewForABar) {
  CoverRequest request;
  request.cover_m = 0.01;
  const RobotCover cover = CoverLinks({Knob(), {}, Bar()}, request);
  ASSERT_EQ(cover.links.size(), 3u);
  EXPECT_EQ(cover.links[0].spheres.size(), 1u);
  EXPECT_LE((cover.links[0].spheres[0].center_m - Eigen::Vector3d(0.3, 0, 0)).norm(), 1e-3);
  EXPECT_TRUE(cover.links[1].spheres.empty());
  EXPECT_LE(cover.links[2].spheres.size(), 3u);
  EXPECT_LE(cover.excess(), 0.35);
}

TEST(CoverLinks, HasLessVolumeWithMoreSpheresAndReachesLessWithFewer) {
  CoverRequest fewest;
  fewest.cover_m = 0.01;
  const RobotCover few = CoverLinks({Bar()}, fewest);
  CoverRequest more = fewest;
  more.num_spheres = few.num_spheres() + 4;
  const RobotCover many = CoverLinks({Bar()}, more);
  EXPECT_LE(many.num_spheres(), more.num_spheres);
  EXPECT_LT(many.excess(), few.excess());
  CoverRequest two;
  two.num_spheres = 2;
  const RobotCover coarse = CoverLinks({Bar()}, two);
  EXPECT_LE(coarse.num_spheres(), 2);
  EXPECT_GT(coarse.cover_m, few.cover_m);
  EXPECT_LE(coarse.excess(), 0.35);
  EXPECT_LE(SeenToStickOut(Bar(), coarse.links[0].spheres, coarse.cover_m, 0.002), coarse.cover_m);
}

TEST(CoverLinks, GivesTheSameSpheresAgain) {
  CoverRequest request;
  request.cover_m = 0.02;
  const RobotCover one = CoverLinks({Bar()}, request), other = CoverLinks({Bar()}, request);
  ASSERT_EQ(one.num_spheres(), other.num_spheres());
  for (int i = 0; i < one.num_spheres(); ++i) {
    const CoverSphere& a = one.links[0].spheres[static_cast<std::size_t>(i)];
    const CoverSphere& b = other.links[0].spheres[static_cast<std::size_t>(i)];
    EXPECT_EQ(a.center_m, b.center_m);
    EXPECT_EQ(a.radius_m, b.radius_m);
  }
}

TEST(CoverLinks, RefusesAMeshThatIsNotClosedByItsName) {
  TriangleMesh open = OuterMesh({Box{{0.1, 0.1, 0.1}}, Pose()}, 0.1);
  open.triangles.conservativeResize(3, 11);
  CoverRequest request;
  request.cover_m = 0.01;
  try {
    CoverLinks({{{}, {{"wrist.stl", open}}}}, request);
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::StartsWith("wrist.stl: is not closed: "));
  }
}

TEST(CoverLinks, RefusesARequestThatMakesNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const CoverRequest& request :
       {CoverRequest{}, CoverRequest{-1, 0, 0.3}, CoverRequest{nan, 5, 0.3},
        CoverRequest{0.01, 0, -1}, CoverRequest{0.01, 1, 0.3}, CoverRequest{0.01, -1, 0.3}}) {
    EXPECT_THROW(CoverLinks({Bar(), Knob()}, request), std::invalid_argument);
  }
}

TEST(CheckCover, TellsWhichSolidSticksOutAndWhere) {
  const LinkSolids solids{
      {{Box{{0.2, 0.2, 0.2}}, Pose()}, {Sphere{0.1}, Pose::Translation({1, 0, 0})}}, {}};
  const CoverCheck check = CheckCover(solids, {{{0, 0, 0}, 0.2}}, 1e-5);
  EXPECT_NEAR(check.uncovered_m, 0.9, 2e-5);
  EXPECT_EQ(check.solid, 1u);
  EXPECT_LE((check.p_m - Eigen::Vector3d(1.1, 0, 0)).norm(), 0.01);
  EXPECT_EQ(CheckCover(solids, {}, 1e-5).uncovered_m, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace sidestep::imports
