#include "sidestep/sdf/composite_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "sidestep/core/shape.h"
#include "sidestep/sdf/dense_composite.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"
#include "tests/sdf/box_scene.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::composite_field_test {
namespace {

constexpr double kCell_m = 0.04;
constexpr double kClamp_m = 0.4;

GridSpec Grid() { return {{-1, -1, -1}, kCell_m, {56, 50, 44}}; }

OccupancyGrid Furniture() {
  OccupancyGrid grid(Grid());
  FillBox({1.4, 0.4, 0.08}, {-0.1, 0.45, -0.2}, grid);
  FillBox({0.12, 0.4, 1.6}, {0.66, -0.5, -0.1}, grid);
  return grid;
}

std::shared_ptr<const SdfGrid> FieldOf(const OccupancyGrid& grid) {
  return std::make_shared<const SdfGrid>(ComputeSignedDistance(grid));
}

// A pillar of 5 x 5 x 21 cells around its frame's origin, which lies in the centre of a cell.
OccupancyGrid Pillar() {
  OccupancyGrid shape({{-2 * kCell_m, -2 * kCell_m, -10 * kCell_m}, kCell_m, {5, 5, 21}});
  std::fill(shape.cells.begin(), shape.cells.end(), 1);
  return shape;
}

std::shared_ptr<const SdfGrid> PillarField() {
  return std::make_shared<const SdfGrid>(MakeObjectField(Pillar(), kClamp_m));
}

void FillPillar(const std::array<int, 3>& centre, OccupancyGrid& grid) {
  for (int k = centre[2] - 10; k <= centre[2] + 10; ++k)
    for (int j = centre[1] - 2; j <= centre[1] + 2; ++j)
      for (int i = centre[0] - 2; i <= centre[0] + 2; ++i)
        if (grid.spec.Contains(i, j, k)) grid.cells[grid.spec.Index(i, j, k)] = 1;
}

MovingField Standing(std::shared_ptr<const SdfGrid> field_O, const Pose& X_WO) {
  return {std::move(field_O), [X_WO](EpisodeTime) { return X_WO; }};
}

template <class Visitor>
void ForEachCell(const GridSpec& spec, const Visitor& visit) {
  for (int k = 0; k < spec.size[2]; ++k)
    for (int j = 0; j < spec.size[1]; ++j)
      for (int i = 0; i < spec.size[0]; ++i) visit(i, j, k);
}

// Where the pillar stands free, passes the furniture, is cut off by the border, has left.
const std::array<int, 3> kPillarCells[] = {{20, 8, 20}, {30, 29, 24}, {1, 20, 20},
                                           {54, 48, 3}, {20, 60, 20}, {35, 20, -20}};

TEST(CompositeField, EqualsTheClampedExactFieldAtFreeCentresForWholeCellShifts) {
  const auto furniture = FieldOf(Furniture());
  for (const auto& centre : kPillarCells) {
    OccupancyGrid world = Furniture();
    FillPillar(centre, world);
    const SdfGrid exact = ComputeSignedDistance(world);
    const CompositeField field(furniture,
                               {Standing(PillarField(), Pose::Translation(Grid().Center(
                                                            centre[0], centre[1], centre[2])))},
                               kClamp_m);
    double worst_m = 0;
    ForEachCell(Grid(), [&](int i, int j, int k) {
      if (world.At(i, j, k)) return;
      const double distance_m = field.Sample(Grid().Center(i, j, k), EpisodeTime(0)).distance_m;
      // What has left the grid the exact field cannot know.
      const double expected_m = std::min<double>(exact.At(i, j, k), kClamp_m);
      const bool all_inside = centre[0] >= 2 && centre[1] >= 2 && centre[2] >= 10 &&
                              centre[0] <= 53 && centre[1] <= 47 && centre[2] <= 33;
      if (all_inside) {
        worst_m = std::max(worst_m, std::abs(distance_m - expected_m));
      } else {
        worst_m = std::max(worst_m, distance_m - expected_m);
      }
    });
    EXPECT_LT(worst_m, 1e-6);  // floats
  }
}

TEST(CompositeField, HasNoJumpWhereAnObjectsGridEnds) {
  const auto nothing = FieldOf(OccupancyGrid(Grid()));
  const auto pillar = PillarField();
  const Pose X_WO = Pose::FromRollPitchYaw({0.3, -0.2, 0.5}, {0.013, -0.027, -0.1});
  const CompositeField field(nothing, {Standing(pillar, X_WO)}, kClamp_m);
  RandomStream random(1, "points");
  const Eigen::Vector3d low = pillar->spec().first_center_m, high = pillar->last_center_m();
  for (int n = 0; n < 6000; ++n) {
    Eigen::Vector3d p_O = (low + high) / 2 + UniformPoint(random, 0.5).cwiseProduct(high - low);
    const int axis = n % 3;
    const double outwards = n / 3 % 2 == 0 ? -1e-7 : 1e-7;
    p_O(axis) = outwards < 0 ? low(axis) : high(axis);
    Eigen::Vector3d p_OBeyond = p_O, p_OWithin = p_O;
    p_OBeyond(axis) += outwards;
    p_OWithin(axis) -= outwards;
    const double within = field.Sample(X_WO * p_OWithin, EpisodeTime(0)).distance_m;
    const double beyond = field.Sample(X_WO * p_OBeyond, EpisodeTime(0)).distance_m;
    ASSERT_LT(std::abs(within - beyond), 1e-6);
  }
}

TEST(CompositeField, IsContinuousAlongAWayThroughEverything) {
  const CompositeField field(
      FieldOf(Furniture()),
      {Standing(PillarField(), Pose::FromRollPitchYaw({0, 0, 0.7}, {0.2, -0.1, -0.15}))}, kClamp_m);
  const Eigen::Vector3d from(-0.9, 0.7, -0.5), to(1.1, -0.8, 0.3);
  constexpr int kSteps = 200000;
  double last = field.Sample(from, EpisodeTime(0)).distance_m;
  for (int n = 1; n <= kSteps; ++n) {
    const Eigen::Vector3d p = from + (to - from) * n / kSteps;
    const double distance_m = field.Sample(p, EpisodeTime(0)).distance_m;
    // Distances have slope 1; their interpolant, at most sqrt(3).
    ASSERT_LT(std::abs(distance_m - last), 1.8 * (to - from).norm() / kSteps);
    last = distance_m;
  }
}

// The kinks of an interpolant lie on cell faces and where two things are equally near; elsewhere
// its gradient is the slope of its values.
TEST(CompositeField, HasTheGradientOfItsValueInTheWorldFrame) {
  const Pose X_WO = Pose::FromRollPitchYaw({0.4, -0.3, 1.1}, {0.1, -0.1, -0.1});
  const CompositeField field(FieldOf(Furniture()), {Standing(PillarField(), X_WO)}, kClamp_m);
  RandomStream random(2, "points");
  constexpr double kStep_m = 1e-6;
  int compared = 0, off = 0;
  for (int n = 0; n < 20000; ++n) {
    const Eigen::Vector3d p = UniformPoint(random, 0.7) - Eigen::Vector3d::Constant(0.1);
    const DistanceSample sample = field.Sample(p, EpisodeTime(0));
    if (sample.distance_m == kClamp_m) continue;
    Eigen::Vector3d slope;
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d d = kStep_m * Eigen::Vector3d::Unit(a);
      slope(a) = (field.Sample(p + d, EpisodeTime(0)).distance_m -
                  field.Sample(p - d, EpisodeTime(0)).distance_m) /
                 (2 * kStep_m);
    }
    ++compared;
    if ((slope - sample.gradient_W).norm() > 1e-6) ++off;
  }
  EXPECT_GT(compared, 5000);
  // A point is within a step of one of the six cell faces around it with a chance of 2e-4 or so.
  EXPECT_LT(off, compared / 500);
}

TEST(CompositeField, PutsAnObjectWhereItIsAtTheTimeAskedAbout) {
  // Seen at p0 at t0 and going on from there with v.
  const EpisodeTime t0(1.5);
  const Eigen::Vector3d p0(-0.5, -0.4, 0), v(0.5, 0.2, 0);
  const CompositeField field(
      FieldOf(OccupancyGrid(Grid())),
      {{PillarField(),
        [=](EpisodeTime t) { return Pose::Translation(p0 + v * (t - t0).seconds()); }}},
      kClamp_m);
  for (const double t_s : {0.9, 1.5, 2.0, 3.1}) {
    const Eigen::Vector3d p_WO = p0 + v * (t_s - 1.5);
    // Half a cell beyond the 5 x 5 cells' face, and the deepest place.
    EXPECT_NEAR(
        field.Sample(p_WO + Eigen::Vector3d(3 * kCell_m, 0, 0), EpisodeTime(t_s)).distance_m,
        kCell_m / 2, 1e-6);
    EXPECT_NEAR(field.Sample(p_WO, EpisodeTime(t_s)).distance_m, -2.5 * kCell_m, 1e-6);
    EXPECT_EQ(field.Sample(p_WO, EpisodeTime(t_s + 1.5)).distance_m, kClamp_m);
  }
}

TEST(CompositeField, LetsAnObjectCountWhereTheStaticGridEnds) {
  const Eigen::Vector3d p_WO(-1.1, 0, 0);  // 10 cm outside
  const CompositeField field(FieldOf(OccupancyGrid(Grid())),
                             {Standing(PillarField(), Pose::Translation(p_WO))}, kClamp_m);
  const DistanceSample at_object = field.Sample(p_WO, EpisodeTime(0));
  EXPECT_NEAR(at_object.distance_m, -0.1, 1e-6);
  EXPECT_FALSE(at_object.in_grid);
  const DistanceSample elsewhere = field.Sample({-3, 0, 0}, EpisodeTime(0));
  EXPECT_EQ(elsewhere.distance_m, kClamp_m);
  EXPECT_EQ(elsewhere.gradient_W, Eigen::Vector3d::Zero());
  EXPECT_FALSE(elsewhere.in_grid);
}

TEST(CompositeField, AnswersManyPointsAsItAnswersEach) {
  const Pose X_WO = Pose::FromRollPitchYaw({0.4, -0.3, 1.1}, {0.1, -0.1, -0.1});
  int num_poses_asked = 0;
  const MovingField pillar{PillarField(), [&](EpisodeTime) {
                             ++num_poses_asked;
                             return X_WO;
                           }};
  const CompositeField field(FieldOf(Furniture()), {pillar, pillar}, kClamp_m);
  RandomStream random(3, "points");
  const Eigen::Matrix3Xd p = UniformPoints(random, 500, 1.3);
  DistanceSamples samples;
  field.SampleMany(p, EpisodeTime(0), samples);
  EXPECT_EQ(num_poses_asked, 2) << "once an object";
  ASSERT_EQ(samples.distance_m.size(), 500);
  int num_outside = 0;
  for (int s = 0; s < 500; ++s) {
    const DistanceSample one = field.Sample(p.col(s), EpisodeTime(0));
    EXPECT_EQ(samples.distance_m(s), one.distance_m);
    EXPECT_EQ(samples.gradient_W.col(s), one.gradient_W);
    num_outside += one.in_grid ? 0 : 1;
  }
  EXPECT_EQ(samples.num_outside, num_outside);
  EXPECT_GT(num_outside, 0);
}

TEST(CompositeField, RefusesAnObjectWithTooLittlePadding) {
  const auto too_small = std::make_shared<const SdfGrid>(MakeObjectField(Pillar(), kClamp_m - 0.2));
  EXPECT_THROW(CompositeField(FieldOf(Furniture()), {Standing(too_small, Pose())}, kClamp_m),
               std::invalid_argument);
  EXPECT_THROW(CompositeField(nullptr, {}, kClamp_m), std::invalid_argument);
  EXPECT_THROW(CompositeField(FieldOf(Furniture()), {}, 0), std::invalid_argument);
  EXPECT_THROW(CompositeField(FieldOf(Furniture()), {{nullptr, nullptr}}, kClamp_m),
               std::invalid_argument);
}

// Arbitrary offsets and query points, against the exact distance to the moved cubes.
TEST(CompositeField, IsWithin3MillimetresInFreeSpaceForAlmostAllOffsetsAndPoints) {
  const auto nothing = FieldOf(OccupancyGrid(Grid()));
  const auto pillar = PillarField();
  const Box solid{{5 * kCell_m, 5 * kCell_m, 21 * kCell_m}};
  RandomStream random(4, "offsets and points");
  std::vector<double> errors_m, near_errors_m;
  for (int n = 0; n < 200; ++n) {
    const Pose X_WO = Pose::Translation(UniformPoint(random, 0.1));
    const CompositeField field(nothing, {Standing(pillar, X_WO)}, kClamp_m);
    for (int m = 0; m < 1000; ++m) {
      const Eigen::Vector3d p = UniformPoint(random, 0.8);
      const double exact_m = SignedDistance(solid, X_WO.Inverse() * p);
      const double error_m = std::abs(field.Sample(p, EpisodeTime(0)).distance_m - exact_m);
      if (exact_m > 1.75 * kCell_m && exact_m < kClamp_m - kCell_m) errors_m.push_back(error_m);
      if (exact_m > 0 && exact_m <= 1.75 * kCell_m) near_errors_m.push_back(error_m);
    }
  }
  EXPECT_GT(errors_m.size(), 40000u);
  EXPECT_GT(near_errors_m.size(), 3000u);
  const auto p99 = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() * 99 / 100];
  };
  EXPECT_LT(p99(errors_m), 0.003);
  EXPECT_LT(p99(near_errors_m), 0.010);
}

TEST(ShapeField, SaysBeforehandHowManyCellsItTakesAndRefusesTooMany) {
  for (const Shape& shape : {Shape(Sphere{0.11}), Shape(Box{{0.3, 0.02, 0.1}})}) {
    const SdfGrid field = MakeShapeField(shape, kCell_m, kClamp_m);
    EXPECT_EQ(ShapeFieldCells(shape, kCell_m, kClamp_m),
              static_cast<double>(field.spec().num_cells()));
  }
  EXPECT_THROW(MakeShapeField(Sphere{1000}, kCell_m, kClamp_m), std::invalid_argument);
  EXPECT_THROW(MakeShapeField(Sphere{1e12}, 1e-3, kClamp_m), std::invalid_argument);
}

struct ShapeCase {
  const char* name;
  Shape shape;
};

TEST(ShapeField, IsTheClosedFormWithinAFewMillimetresOutside) {
  const ShapeCase kShapes[] = {{"box", Box{{0.48, 0.55, 0.7}}},
                               {"sphere", Sphere{0.2}},
                               {"capsule", Capsule{0.1, 0.3}},
                               {"cylinder", Cylinder{0.15, 0.4}},
                               {"ellipsoid", Ellipsoid{{0.1, 0.2, 0.3}}}};
  RandomStream random(5, "points");
  for (const auto& [name, shape] : kShapes) {
    SCOPED_TRACE(name);
    const SdfGrid field = MakeShapeField(shape, kCell_m, kClamp_m);
    int compared = 0;
    double worst_m = 0;
    for (int n = 0; n < 50000; ++n) {
      const Eigen::Vector3d p = UniformPoint(random, 0.8);
      const double exact_m = SignedDistance(shape, p);
      if (exact_m < 1.75 * kCell_m || exact_m > kClamp_m) continue;
      const GridSample sample = field.Sample(p);
      ASSERT_TRUE(sample.in_grid) << "too little padding";
      ++compared;
      worst_m = std::max(worst_m, std::abs(sample.distance_m - exact_m));
    }
    EXPECT_GT(compared, 5000);
    // Linear interpolation of a curved distance: cell^2 / 8 by each of two curvatures, at most
    // 1 / distance each.
    EXPECT_LT(worst_m, 2 * kCell_m * kCell_m / 8 / (1.75 * kCell_m));
  }
}

TEST(DenseComposite, EqualsTheLazyOneAtCentresForWholeCellShifts) {
  const auto furniture = FieldOf(Furniture());
  for (const auto& centre : kPillarCells) {
    const MovingField pillar =
        Standing(PillarField(), Pose::Translation(Grid().Center(centre[0], centre[1], centre[2])));
    const SdfGrid dense = ComposeDense(*furniture, {pillar}, EpisodeTime(0));
    const CompositeField lazy(furniture, {pillar}, kClamp_m);
    double worst_m = 0;
    ForEachCell(Grid(), [&](int i, int j, int k) {
      const double dense_m = std::min<double>(dense.At(i, j, k), kClamp_m);
      const double lazy_m = lazy.Sample(Grid().Center(i, j, k), EpisodeTime(0)).distance_m;
      worst_m = std::max(worst_m, std::abs(dense_m - lazy_m));
    });
    EXPECT_LT(worst_m, 1e-6);
  }
}

TEST(DenseComposite, RoundsAnObjectToTheNearestCell) {
  const auto nothing = FieldOf(OccupancyGrid(Grid()));
  const Eigen::Vector3d centre = Grid().Center(20, 20, 20);
  const auto composed = [&](const Eigen::Vector3d& p_WO) {
    return ComposeDense(*nothing, {Standing(PillarField(), Pose::Translation(p_WO))},
                        EpisodeTime(0))
        .distance_m();
  };
  EXPECT_EQ(composed(centre + Eigen::Vector3d(0.019, -0.019, 0)), composed(centre));
  EXPECT_NE(composed(centre + Eigen::Vector3d(0.021, 0, 0)), composed(centre));
}

TEST(DenseSteps, AreTheDenseCompositesOfTheirTimesInAnyOrder) {
  const auto furniture = FieldOf(Furniture());
  const auto pillar = PillarField();
  const auto moving = [&](const Eigen::Vector3d& p_WStart, const Eigen::Vector3d& v_WO) {
    return MovingField{
        pillar, [=](EpisodeTime t) { return Pose::Translation(p_WStart + t.seconds() * v_WO); }};
  };
  // Two that cross, and one that comes and goes far beyond the grid.
  const std::vector<MovingField> objects = {moving({-0.5, 0, 0}, {0.4, 0.1, 0}),
                                            moving({0.5, 0, 0}, {-0.4, 0, 0.1}),
                                            moving({0, -40, 0}, {0, 20, 0})};
  DenseSteps steps(furniture, objects);
  for (const double t_s : {0.0, 0.1, 1.0, 1.0, 2.0, 3.5, 1.1, 1e7, 0.0}) {
    const std::span<const float> step = steps.At(EpisodeTime(t_s));
    const SdfGrid expected = ComposeDense(*furniture, objects, EpisodeTime(t_s));
    EXPECT_TRUE(std::equal(step.begin(), step.end(), expected.distance_m().begin(),
                           expected.distance_m().end()))
        << t_s << " s";
  }
  EXPECT_THROW(DenseSteps(nullptr, objects), std::invalid_argument);
}

TEST(DenseComposite, RefusesObjectsItCannotCopyCellByCell) {
  const auto nothing = FieldOf(OccupancyGrid(Grid()));
  EXPECT_THROW(
      ComposeDense(*nothing,
                   {Standing(PillarField(), Pose::FromRollPitchYaw({0, 0, 0.1}, {0, 0, 0}))},
                   EpisodeTime(0)),
      std::invalid_argument);
  const auto other_cells =
      std::make_shared<const SdfGrid>(MakeShapeField(Sphere{0.1}, 0.05, kClamp_m));
  EXPECT_THROW(ComposeDense(*nothing, {Standing(other_cells, Pose())}, EpisodeTime(0)),
               std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::sdf::composite_field_test
