#include "sidestep/sdf/shape_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sidestep/core/random.h"

namespace sidestep::sdf::shape_field_test {
namespace {

constexpr double kClamp_m = 0.5;

// A turned box, a capsule, the floor, a slope, and a ball that rises at 1 m/s.
StaticSolids Still() {
  return {{{Box{{0.4, 0.2, 0.6}}, Pose::FromRollPitchYaw({0.3, -0.5, 1.1}, {0.2, 0.1, 0.4})},
           {Capsule{0.1, 0.3}, Pose::Translation({-0.5, 0.4, 0.3})}},
          {{{0, 0, 1}, -0.1}, {{0.6, 0, 0.8}, -0.7}}};
}
Eigen::Vector3d BallCenter(EpisodeTime t) { return {-0.2, -0.4, t.seconds()}; }
ShapeField World(double max_distance_m) {
  return ShapeField(
      Still(), {{Sphere{0.15}, [](EpisodeTime t) { return Pose::Translation(BallCenter(t)); }}},
      max_distance_m);
}

double Truth(const Eigen::Vector3d& p, EpisodeTime t) {
  double least_m = (p - BallCenter(t)).norm() - 0.15;
  for (const PlacedShape& placed : Still().shapes) {
    least_m = std::min(least_m, SignedDistance(placed.shape, placed.X_WO.Inverse() * p));
  }
  return std::min({least_m, p.z() + 0.1, 0.6 * p.x() + 0.8 * p.z() + 0.7});
}

Eigen::Vector3d Anywhere(RandomStream& random) {
  return {2 * random.Uniform() - 1, 2 * random.Uniform() - 1, 2 * random.Uniform() - 1};
}

TEST(ShapeField, IsTheLeastDistanceToEverythingAtThatTime) {
  const ShapeField unclamped = World(std::numeric_limits<double>::infinity());
  const ShapeField field = World(kClamp_m);
  RandomStream random(1, "points");
  int num_clamped = 0;
  for (int n = 0; n < 4000; ++n) {
    const Eigen::Vector3d p = 2 * Anywhere(random);
    const EpisodeTime t(random.Uniform());
    const double truth_m = Truth(p, t);
    ASSERT_NEAR(unclamped.Distance(p, t), truth_m, 1e-12);
    ASSERT_NEAR(unclamped.Sample(p, t).distance_m, truth_m, 1e-12);
    ASSERT_NEAR(field.Distance(p, t), truth_m, 1e-12);
    const DistanceSample sample = field.Sample(p, t);
    ASSERT_NEAR(sample.distance_m, std::min(truth_m, kClamp_m), 1e-12);
    ASSERT_TRUE(sample.in_grid);
    if (truth_m < kClamp_m - 1e-9) continue;
    ++num_clamped;
    ASSERT_EQ(sample.gradient_W, Eigen::Vector3d::Zero());
  }
  EXPECT_GT(num_clamped, 100);
}

TEST(ShapeField, HasTheGradientOfItsValue) {
  const ShapeField field = World(kClamp_m);
  RandomStream random(2, "points");
  constexpr double kStep_m = 1e-6;
  int num_smooth = 0;
  for (int n = 0; n < 3000; ++n) {
    const Eigen::Vector3d p = Anywhere(random);
    const EpisodeTime t(random.Uniform());
    const DistanceSample sample = field.Sample(p, t);
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(a);
      const double above = field.Sample(p + step, t).distance_m - sample.distance_m;
      const double below = sample.distance_m - field.Sample(p - step, t).distance_m;
      if (std::abs(above - below) > 1e-4 * kStep_m) continue;  // a crease
      ++num_smooth;
      ASSERT_NEAR(sample.gradient_W(a), (above + below) / (2 * kStep_m), 1e-4);
    }
  }
  EXPECT_GT(num_smooth, 5000);
}

TEST(ShapeField, AnswersManyPointsAsItAnswersEach) {
  const ShapeField field = World(kClamp_m);
  RandomStream random(3, "points");
  Eigen::Matrix3Xd p_WQ(3, 500);
  for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) p_WQ.col(s) = Anywhere(random);
  DistanceSamples samples;
  field.SampleMany(p_WQ, EpisodeTime(0.4), samples);
  EXPECT_EQ(samples.num_outside, 0);
  for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
    const DistanceSample one = field.Sample(p_WQ.col(s), EpisodeTime(0.4));
    ASSERT_EQ(samples.distance_m(s), one.distance_m);
    ASSERT_EQ(samples.gradient_W.col(s), one.gradient_W);
  }
}

TEST(ShapeField, OfNothingIsFreeEverywhere) {
  const ShapeField nothing({});
  EXPECT_EQ(nothing.Distance({1, 2, 3}, EpisodeTime(0)), std::numeric_limits<double>::infinity());
  EXPECT_EQ(ShapeField({}, {}, kClamp_m).Sample({1, 2, 3}, EpisodeTime(0)).distance_m, kClamp_m);
}

TEST(ShapeField, RefusesAClampOfNothingAndAShapeWithoutAPose) {
  EXPECT_THROW(ShapeField({}, {}, 0), std::invalid_argument);
  EXPECT_THROW(ShapeField({}, {}, std::nan("")), std::invalid_argument);
  EXPECT_THROW(ShapeField({}, {{Sphere{1}, nullptr}}), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::sdf::shape_field_test
