#include "sidestep/sdf/map/sdf_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "sidestep/sdf/grid_field.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::sdf_grid_test {
namespace {

// 0.04 and -1 are not exact in binary: the far centres are where rounding would show.
GridSpec Spec() { return {{-1, -1, -1}, 0.04, {96, 7, 5}}; }

SdfGrid RandomGrid(const GridSpec& spec) {
  RandomStream random(3, "values");
  AlignedVector<float> values(spec.num_cells());
  for (float& value : values) value = static_cast<float>(random.Uniform(-0.5, 0.5));
  return SdfGrid(spec, values);
}

Eigen::Vector3d RandomPointWithin(const SdfGrid& grid, RandomStream& random) {
  const Eigen::Vector3d low = grid.spec().first_center_m, high = grid.last_center_m();
  return (low + high) / 2 + UniformPoint(random, 0.5).cwiseProduct(high - low);
}

TEST(SdfGrid, IsExactAtEveryCellCentre) {
  const SdfGrid grid = RandomGrid(Spec());
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 96; ++i) {
        const GridSample sample = grid.Sample(grid.spec().Center(i, j, k));
        ASSERT_TRUE(sample.in_grid) << i << ' ' << j << ' ' << k;
        ASSERT_NEAR(sample.distance_m, grid.At(i, j, k), 1e-12);
      }
}

TEST(SdfGrid, ReproducesATrilinearFunction) {
  const auto f = [](const Eigen::Vector3d& p) {
    return 0.3 + p.x() - 2 * p.y() + 0.5 * p.x() * p.y() * p.z() - p.y() * p.z();
  };
  const GridSpec spec = Spec();
  AlignedVector<float> values;
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 7; ++j)
      for (int i = 0; i < 96; ++i) values.push_back(static_cast<float>(f(spec.Center(i, j, k))));
  const SdfGrid grid(spec, values);
  RandomStream random(1, "points");
  for (int n = 0; n < 1000; ++n) {
    const Eigen::Vector3d p = RandomPointWithin(grid, random);
    EXPECT_NEAR(grid.Sample(p).distance_m, f(p), 1e-6);
  }
}

TEST(SdfGrid, HasTheGradientOfItsInterpolant) {
  const SdfGrid grid = RandomGrid(Spec());
  RandomStream random(2, "points");
  const double step = 1e-5;
  int compared = 0;
  for (int n = 0; n < 1000; ++n) {
    const Eigen::Vector3d p = RandomPointWithin(grid, random);
    // Within a cell the interpolant is smooth; a difference across two cells means nothing.
    const Eigen::Array3d u = (p - grid.spec().first_center_m).array() / grid.spec().cell_m;
    if (((u - u.round()).abs() < 2 * step / grid.spec().cell_m).any()) continue;
    ++compared;
    const GridSample sample = grid.Sample(p);
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(a);
      const double slope =
          (grid.Sample(p + d).distance_m - grid.Sample(p - d).distance_m) / (2 * step);
      EXPECT_NEAR(sample.gradient(a), slope, 1e-8);
    }
  }
  EXPECT_GT(compared, 900);
}

// Each face, edge and corner: a point on it is inside, the next number outwards is not.
TEST(SdfGrid, ReachesExactlyFromTheFirstToTheLastCentre) {
  const SdfGrid grid = RandomGrid(Spec());
  const Eigen::Vector3d low = grid.spec().first_center_m, high = grid.last_center_m();
  for (int side = 0; side < 27; ++side) {
    const int along[3] = {side % 3, side / 3 % 3, side / 9};
    Eigen::Vector3d on;
    for (int a = 0; a < 3; ++a) {
      on(a) = along[a] == 0 ? low(a) : along[a] == 1 ? high(a) : (low(a) + high(a)) / 2;
    }
    const GridSample sample = grid.Sample(on);
    ASSERT_TRUE(sample.in_grid) << on.transpose();
    EXPECT_LE(std::abs(sample.distance_m), 0.5);
    EXPECT_TRUE(sample.gradient.allFinite());
    for (int a = 0; a < 3; ++a) {
      if (along[a] == 2) continue;
      Eigen::Vector3d beyond = on;
      const double outwards = along[a] == 0 ? -1e9 : 1e9;
      beyond(a) = std::nextafter(on(a), outwards);
      EXPECT_FALSE(grid.Sample(beyond).in_grid) << beyond.transpose();
      Eigen::Vector3d within = on;
      within(a) = std::nextafter(on(a), -outwards);
      EXPECT_TRUE(grid.Sample(within).in_grid) << within.transpose();
      EXPECT_NEAR(grid.Sample(within).distance_m, sample.distance_m, 1e-12);
    }
  }
}

TEST(SdfGrid, OfOneCellIsOnePoint) {
  const SdfGrid grid({{1, 2, 3}, 0.1, {1, 1, 1}}, {0.25F});
  const GridSample sample = grid.Sample({1, 2, 3});
  EXPECT_TRUE(sample.in_grid);
  EXPECT_EQ(sample.distance_m, 0.25);
  EXPECT_EQ(sample.gradient, Eigen::Vector3d::Zero());
  EXPECT_FALSE(grid.Sample({1, 2, 3.0001}).in_grid);
}

TEST(SdfGrid, RefusesAnotherNumberOfValues) {
  EXPECT_THROW(SdfGrid(Spec(), AlignedVector<float>(3, 0.0F)), std::invalid_argument);
  EXPECT_THROW(SdfGrid({{0, 0, 0}, 0, {1, 1, 1}}, {0.0F}), std::invalid_argument);
}

GridField SlopeField(double max_distance_m) {  // distance = x + 1 from x = -1 to 2.8
  const GridSpec spec = Spec();
  AlignedVector<float> values;
  for (int row = 0; row < 7 * 5; ++row)
    for (int i = 0; i < 96; ++i) values.push_back(0.04F * static_cast<float>(i));
  return GridField(std::make_shared<SdfGrid>(spec, values), max_distance_m);
}

TEST(GridField, NeverAnswersMoreThanItsClampAndIsFlatThere) {
  const GridField field = SlopeField(0.3);
  const DistanceSample below = field.Sample({-0.8, -0.9, -0.9}, EpisodeTime(1));
  EXPECT_NEAR(below.distance_m, 0.2, 1e-6);
  EXPECT_NEAR(below.gradient_W.x(), 1, 1e-5);
  const DistanceSample above = field.Sample({-0.6, -0.9, -0.9}, EpisodeTime(1));
  EXPECT_EQ(above.distance_m, 0.3);
  EXPECT_EQ(above.gradient_W, Eigen::Vector3d::Zero());
  EXPECT_TRUE(above.in_grid);
}

TEST(GridField, AnswersItsClampOutsideTheGridAndSaysSo) {
  const DistanceSample sample = SlopeField(0.3).Sample({-1.1, -0.9, -0.9}, EpisodeTime(0));
  EXPECT_EQ(sample.distance_m, 0.3);
  EXPECT_EQ(sample.gradient_W, Eigen::Vector3d::Zero());
  EXPECT_FALSE(sample.in_grid);
}

TEST(GridField, AnswersManyPointsAsItAnswersEach) {
  const GridField field = SlopeField(0.3);
  Eigen::Matrix3Xd p(3, 4);
  p << -0.9, -0.8, -5, 0.5, -0.9, -0.9, -0.9, -0.9, -0.9, -0.9, -0.9, -0.9;
  DistanceSamples samples;
  field.SampleMany(p, EpisodeTime(0), samples);
  ASSERT_EQ(samples.distance_m.size(), 4);
  EXPECT_EQ(samples.num_outside, 1);
  for (int s = 0; s < 4; ++s) {
    const DistanceSample one = field.Sample(p.col(s), EpisodeTime(0));
    EXPECT_EQ(samples.distance_m(s), one.distance_m);
    EXPECT_EQ(samples.gradient_W.col(s), one.gradient_W);
  }
}

TEST(GridField, RefusesToClampAtNothing) {
  const auto grid = std::make_shared<SdfGrid>(RandomGrid(Spec()));
  for (const double clamp_m : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(GridField(grid, clamp_m), std::invalid_argument);
  }
  EXPECT_THROW(GridField(nullptr, 0.3), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::sdf::sdf_grid_test
