#include "sidestep/bench/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sidestep::bench::statistics_test {
namespace {

TEST(Quantile, InterpolatesBetweenOrderStatistics) {
  // R: quantile(c(7, 1, 3, 10), c(0, .25, .5, .9, 1)) -> 1, 2.5, 5, 9.1, 10
  const std::vector<double> values = {7, 1, 3, 10};
  EXPECT_DOUBLE_EQ(Quantile(values, 0), 1);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.25), 2.5);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.5), 5);
  EXPECT_DOUBLE_EQ(Quantile(values, 0.9), 9.1);
  EXPECT_DOUBLE_EQ(Quantile(values, 1), 10);
}

TEST(Quantile, OfOneValueIsThatValue) { EXPECT_EQ(Quantile({4.5}, 0.95), 4.5); }

TEST(Quantile, OfNothingIsNotANumber) { EXPECT_TRUE(std::isnan(Quantile({}, 0.5))); }

}  // namespace
}  // namespace sidestep::bench::statistics_test
