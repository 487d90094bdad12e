// Predicted steps cost no grids: a composite field is the static field and the objects' fields.
#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/fast_distance_transform.h"
#include "sidestep/sdf/map/object_field.h"
#include "tests/sdf/box_scene.h"
#include "tests/support/allocations.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf {
namespace {

TEST(CompositeField, OfManyStepsTakesNoMemoryForThem) {
  constexpr double kClamp_m = 0.4;
  const GridSpec grid = WalkwayGrid();
  const auto static_W = std::make_shared<const SdfGrid>(
      FastDistanceTransform().Compute(Rasterise(WalkwayTables(), grid, EpisodeTime(0))));
  const auto field_O =
      std::make_shared<const SdfGrid>(MakeShapeField(Box{{0.48, 0.55, 1.2}}, 0.04, kClamp_m));
  const std::size_t grid_bytes = static_W->distance_m().size() * sizeof(float);
  const std::size_t before = CountAllocations().bytes;
  ASSERT_GT(before, grid_bytes) << "allocations are not counted";

  const CompositeField field(static_W,
                             {{field_O,
                               [](EpisodeTime t) {
                                 return Pose::Translation({0.4, 2 - t.seconds(), 0.6});
                               }}},
                             kClamp_m);
  RandomStream random(1, "points");
  const Eigen::Matrix3Xd p_WQ = UniformPoints(random, 640, 1);
  DistanceSamples samples;
  int num_lowered = 0;
  for (int step = 0; step < 31; ++step) {
    field.SampleMany(p_WQ, EpisodeTime(0.1 * step), samples);
    num_lowered += samples.distance_m.minCoeff() < 0 ? 1 : 0;
  }
  EXPECT_GT(num_lowered, 0);
  EXPECT_LT(CountAllocations().bytes - before, grid_bytes / 50);
}

}  // namespace
}  // namespace sidestep::sdf
