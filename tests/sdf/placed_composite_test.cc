#include "sidestep/sdf/placed_composite.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/core/shape.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"
#include "tests/sdf/only_target.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::placed_composite_test {
namespace {

constexpr double kCell_m = 0.05;
constexpr double kClamp_m = 0.3;

OccupancyGrid RandomCells(RandomStream& random, const std::array<int, 3>& size, double share) {
  OccupancyGrid grid({Eigen::Vector3d::Constant(-1), kCell_m, size});
  for (auto& cell : grid.cells) cell = random.Uniform() < share ? 1 : 0;
  return grid;
}

struct World {
  SdfGrid static_W;
  std::vector<SdfGrid> shapes;
  std::vector<PlacedObject> objects;  // of the shapes
  StaticSolids exact = {};
};

// Objects of a few shapes, turned any way, all over a static grid and beyond it.
World RandomWorld(RandomStream& random, const std::array<int, 3>& size, int num_objects,
                  bool tight) {
  World world{ComputeSignedDistance(RandomCells(random, size, 0.003)), {}, {}};
  world.shapes.push_back(
      MakeObjectField(RandomCells(random, {3, 5, 4}, 0.4), kClamp_m, DistanceConvention::kSurface));
  world.shapes.push_back(
      MakeObjectField(RandomCells(random, {2, 1, 9}, 0.8), kClamp_m, DistanceConvention::kBwdist));
  world.shapes.push_back(MakeShapeField(Sphere{0.11}, kCell_m, kClamp_m));
  world.shapes.push_back(MakeShapeField(Box{{0.3, 0.02, 0.1}}, kCell_m, kClamp_m));
  for (int n = 0; n < num_objects; ++n) {
    const SdfGrid& field = world.shapes[static_cast<std::size_t>(n) % world.shapes.size()];
    const Eigen::Vector3d p_WO = UniformPoint(random, 1.2);
    const Pose X_WO = n % 3 == 0 ? Pose::Translation(p_WO)
                                 : Pose::FromRollPitchYaw(UniformPoint(random, 3), p_WO);
    world.objects.push_back({&field, tight ? TightBound(field) : DomainBound(field), X_WO});
  }
  return world;
}

// The floor, a slope, and shapes that stand in the grid and beyond it.
StaticSolids SomeSolids(RandomStream& random) {
  StaticSolids solids;
  solids.half_spaces = {{{0, 0, 1}, -0.9}, {{0.36, -0.48, 0.8}, -1.1}};
  const Shape shapes[] = {Box{{0.5, 0.02, 0.4}}, Cylinder{0.05, 0.6}, Ellipsoid{{0.1, 0.2, 0.3}}};
  for (const Shape& shape : shapes) {
    const Eigen::Vector3d p_WO = UniformPoint(random, 1.2);
    solids.shapes.push_back({shape, Pose::FromRollPitchYaw(UniformPoint(random, 3), p_WO)});
  }
  return solids;
}

// The definition: the least of all, without any shortcut.
DistanceSample Least(const World& world, const Eigen::Vector3d& p_WQ) {
  const GridSample fixed = world.static_W.Sample(p_WQ);
  DistanceSample least{kClamp_m, Eigen::Vector3d::Zero(), fixed.in_grid};
  if (fixed.in_grid && fixed.distance_m < kClamp_m) {
    least = {fixed.distance_m, fixed.gradient, true};
  }
  const ExactSolids solids(world.exact);
  solids.Lower(p_WQ, least);
  for (const PlacedObject& object : world.objects) {
    const GridSample sample = object.field_O->Sample(object.X_WO.Inverse() * p_WQ);
    if (sample.in_grid && sample.distance_m < least.distance_m) {
      least.distance_m = sample.distance_m;
      least.gradient_W = object.X_WO.Rotate(sample.gradient);
    }
  }
  return least;
}

// Anywhere, at centres, on the borders of the static grid and just beyond.
Eigen::Matrix3Xd Points(RandomStream& random, const SdfGrid& grid, int count) {
  Eigen::Matrix3Xd p_WQ(3, count);
  for (int s = 0; s < count; ++s) {
    Eigen::Vector3d p = UniformPoint(random, 1.5);
    const auto axis = static_cast<Eigen::Index>(random.Bits() % 3);
    const double low = grid.spec().first_center_m(axis), high = grid.last_center_m()(axis);
    if (s % 4 == 1) p = grid.spec().Center(s % grid.spec().size[0], 0, s % grid.spec().size[2]);
    if (s % 8 == 2) p(axis) = low;
    if (s % 8 == 3) p(axis) = high;
    if (s % 8 == 6) p(axis) = std::nextafter(low, -9);
    if (s % 8 == 7) p(axis) = std::nextafter(high, 9);
    p_WQ.col(s) = p;
  }
  return p_WQ;
}

class PlacedCompositeOn : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(PlacedCompositeOn, AnswersBatchesOfAnySizeAsItAnswersEachPoint) {
  const OnlyTarget target(GetParam());
  RandomStream random(1, "scene");
  for (const std::array<int, 3>& size :
       {std::array<int, 3>{40, 33, 41}, {2, 2, 2}, {40, 1, 40}, {1, 1, 1}}) {
    for (const int num_objects : {0, 1, 5, 16, 40}) {
      World world = RandomWorld(random, size, num_objects, num_objects % 2 == 0);
      if (num_objects != 1) world.exact = SomeSolids(random);
      const ExactSolids solids(world.exact);
      const PlacedComposite field(world.static_W, world.objects, kClamp_m, &solids);
      for (const int count : {1, 7, 64, 65, 300}) {
        SCOPED_TRACE(testing::Message() << num_objects << " objects, " << count << " points, grid "
                                        << size[0] << 'x' << size[1] << 'x' << size[2]);
        const Eigen::Matrix3Xd p_WQ = Points(random, world.static_W, count);
        DistanceSamples samples;
        field.SampleMany(p_WQ, samples);
        SampleColumns columns;
        field.SampleMany(PointColumns(p_WQ.transpose()), columns);
        int num_outside = 0;
        for (int s = 0; s < count; ++s) {
          const DistanceSample one = field.Sample(p_WQ.col(s));
          num_outside += one.in_grid ? 0 : 1;
          ASSERT_EQ(samples.distance_m(s), one.distance_m);
          ASSERT_EQ(columns.distance_m(s), one.distance_m);
          ASSERT_EQ(samples.gradient_W.col(s), one.gradient_W);
          ASSERT_EQ(columns.gradient_W.row(s).transpose(), one.gradient_W);
        }
        ASSERT_EQ(samples.num_outside, num_outside);
        ASSERT_EQ(columns.num_outside, num_outside);
      }
    }
  }
}

TEST_P(PlacedCompositeOn, IsTheLeastOfAllFieldsHoweverManyThereAre) {
  const OnlyTarget target(GetParam());
  RandomStream random(2, "scene");
  for (const int num_objects : {0, 1, 3, 15, 16, 17, 64, 128, 300}) {
    for (const bool tight : {false, true}) {
      SCOPED_TRACE(testing::Message() << num_objects << " objects, tight bounds: " << tight);
      World world = RandomWorld(random, {40, 33, 41}, num_objects, tight);
      if (tight) world.exact = SomeSolids(random);
      const ExactSolids solids(world.exact);
      const PlacedComposite field(world.static_W, world.objects, kClamp_m, &solids);
      const Eigen::Matrix3Xd p_WQ = Points(random, world.static_W, 2000);
      int num_by_objects = 0;
      for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
        const DistanceSample expected = Least(world, p_WQ.col(s));
        const DistanceSample sample = field.Sample(p_WQ.col(s));
        ASSERT_NEAR(sample.distance_m, expected.distance_m, 1e-12);
        ASSERT_EQ(sample.in_grid, expected.in_grid);
        const GridSample fixed = world.static_W.Sample(p_WQ.col(s));
        num_by_objects += !fixed.in_grid || sample.distance_m < fixed.distance_m - 1e-3 ? 1 : 0;
      }
      EXPECT_TRUE(num_objects == 0 || num_by_objects > 0);
    }
  }
}

TEST_P(PlacedCompositeOn, HasTheGradientOfItsValue) {
  const OnlyTarget target(GetParam());
  RandomStream random(3, "scene");
  World world = RandomWorld(random, {40, 33, 41}, 20, true);
  world.exact = SomeSolids(random);
  world.exact.shapes.pop_back();  // the ellipsoid's gradient is not a closed form
  const ExactSolids solids(world.exact);
  const PlacedComposite field(world.static_W, world.objects, kClamp_m, &solids);
  const double step_m = 1e-7;
  int num_smooth = 0;
  for (int s = 0; s < 3000; ++s) {
    const Eigen::Vector3d p = UniformPoint(random, 1);
    const DistanceSample sample = field.Sample(p);
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = step_m * Eigen::Vector3d::Unit(a);
      const double above = field.Sample(p + step).distance_m - sample.distance_m;
      const double below = sample.distance_m - field.Sample(p - step).distance_m;
      if (std::abs(above - below) > 1e-6 * step_m) continue;  // a crease
      ++num_smooth;
      ASSERT_NEAR(sample.gradient_W(a), (above + below) / (2 * step_m), 1e-6);
    }
  }
  EXPECT_GT(num_smooth, 4000);
}

TEST_P(PlacedCompositeOn, KnowsTheFloorExactlyInsideTheGridAndBeyondIt) {
  const OnlyTarget target(GetParam());
  const SdfGrid nothing({Eigen::Vector3d::Constant(-1), kCell_m, {40, 40, 40}},
                        AlignedVector<float>(40 * 40 * 40, 1000.0F));
  const ExactSolids floor({{}, {{{0, 0, 1}, 0.123}}});
  const PlacedComposite field(nothing, {}, kClamp_m, &floor);
  RandomStream random(5, "scene");
  const Eigen::Matrix3Xd p_WQ = UniformPoints(random, 1000, 3);
  DistanceSamples samples;
  field.SampleMany(p_WQ, samples);
  int num_outside = 0, num_by_floor = 0;
  for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
    const double height_m = p_WQ(2, s) - 0.123;
    ASSERT_EQ(samples.distance_m(s), std::min(height_m, kClamp_m));
    ASSERT_EQ(samples.gradient_W.col(s),
              (height_m < kClamp_m ? 1.0 : 0.0) * Eigen::Vector3d::UnitZ());
    const bool outside = !nothing.Covers(p_WQ.col(s));
    num_outside += outside ? 1 : 0;
    num_by_floor += outside && height_m < kClamp_m ? 1 : 0;
  }
  EXPECT_EQ(samples.num_outside, num_outside);  // what else is there is not known
  EXPECT_GT(num_by_floor, 300);
}

INSTANTIATE_TEST_SUITE_P(Target, PlacedCompositeOn,
                         ::testing::ValuesIn(hwy::SupportedAndGeneratedTargets()),
                         [](const auto& test) { return std::string(hwy::TargetName(test.param)); });

TEST(TightBound, IsNeverAboveTheFieldAndNearIt) {
  RandomStream random(4, "scene");
  const World world = RandomWorld(random, {3, 3, 3}, 0, true);
  for (const SdfGrid& field : world.shapes) {
    const FieldBound bound = TightBound(field);
    double least_gap_m = 1;
    for (int s = 0; s < 20000; ++s) {
      const Eigen::Vector3d u = (UniformPoint(random, 1).array() + 1) / 2;
      const Eigen::Vector3d p = field.spec().first_center_m +
                                u.cwiseProduct(field.last_center_m() - field.spec().first_center_m);
      const double to_box_m = (bound.low_O - p).cwiseMax(p - bound.high_O).cwiseMax(0.0).norm();
      if (to_box_m == 0) continue;
      const double gap_m = field.Sample(p).distance_m - (to_box_m - bound.slack_m);
      ASSERT_GE(gap_m, 0);
      least_gap_m = std::min(least_gap_m, gap_m);
    }
    EXPECT_LT(least_gap_m, 3 * kCell_m) << "a bound that never comes near is of no use";
  }
}

TEST(TightBound, OfAFieldThatIsFreeEverywhereIsItsDomain) {
  const SdfGrid free({{0, 0, 0}, 0.1, {4, 4, 4}}, AlignedVector<float>(64, 1.0F));
  EXPECT_EQ(TightBound(free).low_O, DomainBound(free).low_O);
  EXPECT_EQ(TightBound(free).high_O, DomainBound(free).high_O);
  EXPECT_EQ(TightBound(free).slack_m, DomainBound(free).slack_m);
}

TEST(AlignedVector, BeginsAtACacheLine) {
  for (const std::size_t size : {1, 3, 1000, 1000000}) {
    const AlignedVector<float> values(size, 0.0F);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(values.data()) % 64, 0u);
  }
}

}  // namespace
}  // namespace sidestep::sdf::placed_composite_test
