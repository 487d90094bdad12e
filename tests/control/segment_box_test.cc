#include "sidestep/control/segment_box.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sidestep/core/random.h"
#include "sidestep/core/shape.h"

namespace sidestep::control::segment_box_test {
namespace {

using Eigen::Vector3d;

Vector3d Random(RandomStream& random, double size) {
  const double x = random.Uniform(-size, size), y = random.Uniform(-size, size);
  return {x, y, random.Uniform(-size, size)};
}

// Against the nearest of many points of the segment, each by the exact distance to the box.
TEST(SegmentBoxDistance, IsThatOfTheNearestPointOfTheSegment) {
  RandomStream random(1, "segments");
  for (int i = 0; i < 3000; ++i) {
    const Vector3d half = Random(random, 0.5).cwiseAbs() + Vector3d::Constant(0.01);
    const Vector3d a = Random(random, 1.5);
    Vector3d b = Random(random, 1.5);
    if (i % 5 == 0) b(i % 3) = a(i % 3);  // along a face
    if (i % 7 == 0) b = a;                // a point
    double nearest = 1e9;
    constexpr int kSteps = 2000;
    for (int k = 0; k <= kSteps; ++k) {
      const Vector3d p = a + (b - a) * k / kSteps;
      nearest = std::min(nearest, std::max(0.0, SignedDistance(Box{2 * half}, p)));
    }
    const double told = SegmentBoxDistance(a, b, half);
    ASSERT_LE(told, nearest + 1e-12) << i;
    ASSERT_GE(told, nearest - (b - a).norm() / kSteps) << i;
    ASSERT_NEAR(told, SegmentBoxDistance(b, a, half), 1e-12) << i;
  }
}

TEST(SegmentBoxDistance, IsZeroWhereTheyMeet) {
  EXPECT_EQ(SegmentBoxDistance({-2, 0.1, 0}, {2, 0.1, 0}, {0.5, 0.5, 0.5}), 0);
  EXPECT_EQ(SegmentBoxDistance({0.1, 0, 0}, {0.2, 0, 0}, {0.5, 0.5, 0.5}), 0);
}

TEST(SegmentBoxDistance, OfAnEdgePassingACornerIsThatOfThePassing) {
  // From (2, 0, 0) to (0, 2, 0), past the corner (0.5, 0.5, 0): nearest at (1, 1, 0).
  EXPECT_NEAR(SegmentBoxDistance({2, 0, 0}, {0, 2, 0}, {0.5, 0.5, 0.5}), std::sqrt(0.5), 1e-12);
}

}  // namespace
}  // namespace sidestep::control::segment_box_test
