// A field at one moment says what the field says of that moment, to the last bit.

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/shape.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/grid_field.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/shape_field.h"
#include "tests/sdf/only_target.h"
#include "tests/support/ball_field.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::field_slice_test {
namespace {

constexpr double kCell_m = 0.05, kClamp_m = 0.3;

std::shared_ptr<const SdfGrid> Room() {
  OccupancyGrid grid({Eigen::Vector3d::Constant(-1), kCell_m, {40, 33, 41}});
  RandomStream random(1, "cells");
  for (auto& cell : grid.cells) cell = random.Uniform() < 0.003 ? 1 : 0;
  return std::make_shared<const SdfGrid>(ComputeSignedDistance(grid));
}

// Turns and rises as time passes.
Pose PoseOfNumber(int n, EpisodeTime t) {
  RandomStream random(static_cast<std::uint64_t>(n), "pose");
  const Eigen::Vector3d turn = UniformPoint(random, 1), p_WO = UniformPoint(random, 1);
  return Pose::FromRollPitchYaw((1 + t.seconds()) * turn,
                                p_WO + t.seconds() * Eigen::Vector3d::UnitZ());
}

StaticSolids Solids() {
  return {{{Box{{0.4, 0.2, 0.6}}, Pose::FromRollPitchYaw({0.3, -0.5, 1.1}, {0.2, 0.1, 0.4})}},
          {{{0, 0, 1}, -0.9}}};
}

// Objects that grow thicker with time.
std::unique_ptr<DistanceField> Composite(int num_objects) {
  std::vector<MovingField> objects;
  const auto shape =
      std::make_shared<const SdfGrid>(MakeShapeField(Box{{0.3, 0.1, 0.2}}, kCell_m, 0.4));
  for (int n = 0; n < num_objects; ++n) {
    objects.push_back({shape, [n](EpisodeTime t) { return PoseOfNumber(n, t); },
                       [](EpisodeTime t) { return 0.02 * t.seconds(); }, 0.1});
  }
  return std::make_unique<CompositeField>(Room(), std::move(objects), kClamp_m, Solids());
}

struct Case {
  std::string name;
  std::function<std::unique_ptr<DistanceField>()> make;
};
std::ostream& operator<<(std::ostream& stream, const Case& test) { return stream << test.name; }

std::vector<Case> Cases() {
  return {
      {"Grid", [] { return std::make_unique<GridField>(Room(), kClamp_m); }},
      {"CompositeWithoutObjects", [] { return Composite(0); }},
      {"CompositeOfOne", [] { return Composite(1); }},
      {"CompositeOfMany", [] { return Composite(20); }},
      {"Shapes",
       [] {
         return std::make_unique<ShapeField>(
             Solids(),
             std::vector<MovingShape>{
                 {Sphere{0.3}, [](EpisodeTime t) { return PoseOfNumber(3, t); }}},
             kClamp_m);
       }},
      {"AnyOther",
       [] {
         return std::make_unique<BallField>(Eigen::Vector3d(0.1, 0.2, 0), Eigen::Vector3d(0, 0, 1),
                                            0.7, kClamp_m);
       }},
  };
}

class FieldSliceOf : public ::testing::TestWithParam<Case> {};

TEST_P(FieldSliceOf, SaysOfItsMomentWhatTheFieldSays) {
  for (const std::int64_t instructions : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTarget only(instructions);
    const std::unique_ptr<DistanceField> field = GetParam().make();
    RandomStream random(2, "points");
    int num_below_clamp = 0;
    for (const double t_s : {0.0, 0.7, 2.3}) {
      const std::unique_ptr<const FieldSlice> slice = field->At(EpisodeTime(t_s));
      for (const int count : {1, 7, 8, 15, 64}) {
        const Eigen::Matrix3Xd p_WQ = UniformPoints(random, count, 1.4);
        DistanceSamples expected;
        field->SampleMany(p_WQ, EpisodeTime(t_s), expected);
        PointBlock block;
        block.count = static_cast<std::size_t>(count);
        for (int s = 0; s < count; ++s) {
          block.x[s] = p_WQ(0, s);
          block.y[s] = p_WQ(1, s);
          block.z[s] = p_WQ(2, s);
        }
        block.Pad();
        EXPECT_EQ(slice->SampleBlock(block), expected.num_outside);
        for (int s = 0; s < count; ++s) {
          ASSERT_EQ(block.distance_m[s], expected.distance_m(s));
          ASSERT_EQ(block.gradient_x[s], expected.gradient_W(0, s));
          ASSERT_EQ(block.gradient_y[s], expected.gradient_W(1, s));
          ASSERT_EQ(block.gradient_z[s], expected.gradient_W(2, s));
          num_below_clamp += expected.distance_m(s) < kClamp_m;
        }
        std::fill_n(block.distance_m, PointBlock::kSize, -1.0);
        block.with_gradients = false;
        EXPECT_EQ(slice->SampleBlock(block), expected.num_outside);
        for (int s = 0; s < count; ++s) ASSERT_EQ(block.distance_m[s], expected.distance_m(s));
      }
    }
    EXPECT_GT(num_below_clamp, 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Every, FieldSliceOf, ::testing::ValuesIn(Cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::sdf::field_slice_test
