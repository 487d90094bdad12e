#include "sidestep/sim/flying_pixels.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

namespace sidestep::sim::flying_pixels_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

struct Row {
  const char* name;
  std::vector<double> depths_m;
  std::vector<bool> flies;
};
std::ostream& operator<<(std::ostream& stream, const Row& row) { return stream << row.name; }

class FlyingPixels : public ::testing::TestWithParam<Row> {};

TEST_P(FlyingPixels, AreThoseBetweenNearAndFarInARowAndInAColumn) {
  const auto& [name, depths_m, flies] = GetParam();
  const int n = static_cast<int>(depths_m.size());
  EXPECT_EQ(FindFlyingPixels({n, 1, depths_m}, 0.1), flies);
  EXPECT_EQ(FindFlyingPixels({1, n, depths_m}, 0.1), flies);
  EXPECT_EQ(FindFlyingPixels({n, 1, depths_m}, 0), std::vector<bool>(depths_m.size(), false));
}

INSTANTIATE_TEST_SUITE_P(
    Rows, FlyingPixels,
    ::testing::Values(Row{"AnEdge", {1, 1, 2, 2}, {false, false, false, false}},
                      Row{"OneBetween", {1, 1, 1.5, 2, 2}, {false, false, true, false, false}},
                      Row{"OneBetweenTheOtherWayRound", {2, 1.5, 1}, {false, true, false}},
                      Row{"OneBetweenAndNothing", {1, 1, 1.5, kNone}, {false, false, true, false}},
                      Row{"AWireBeforeAWall", {2, 1, 2}, {false, false, false}},
                      Row{"AHoleInAWall", {2, 3, 2}, {false, false, false}},
                      Row{"ASlope", {1, 1.09, 1.18, 1.27}, {false, false, false, false}},
                      Row{"NearlyTheWall", {1, 1.95, 2}, {false, false, false}},
                      Row{"Nothing", {kNone, kNone, kNone}, {false, false, false}}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::sim::flying_pixels_test
