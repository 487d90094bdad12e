#include "sidestep/sdf/map/steady_depths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "sidestep/core/random.h"

namespace sidestep::sdf::steady_depths_test {
namespace {

constexpr double kDeviation_m = 0.02;

TEST(SteadyDepths, AverageWhatStaysTheSame) {
  for (const int most : {1, 5, 60}) {
    RandomStream random(1, "noise");
    double square = 0;
    int rays = 0;
    for (; rays < 2000; ++rays) {
      SteadyDepths depths(most);
      SteadyDepths::Mean mean;
      for (int n = 0; n < 5; ++n) {
        mean = depths.Take(0, 2 + kDeviation_m * random.Normal(), kDeviation_m);
      }
      square += std::pow((mean.depth_m - 2) / kDeviation_m, 2) * mean.count;
    }
    // The mean of that many depths has their variance by their number.
    EXPECT_NEAR(square / rays, 1, 4 * std::sqrt(2.0 / rays)) << most;
  }
}

TEST(SteadyDepths, BeginAfreshSeldomWhereNothingChanges) {
  RandomStream random(1, "noise");
  SteadyDepths depths(60);
  int fresh = 0;
  for (int n = 0; n < 10000; ++n) {
    const int count = depths.Take(3, 2 + kDeviation_m * random.Normal(), kDeviation_m).count;
    if (count == 1) ++fresh;
  }
  EXPECT_LT(fresh, 100);
}

TEST(SteadyDepths, TakeAJumpAsItIsMeasured) {
  SteadyDepths depths(60);
  for (int n = 0; n < 60; ++n) depths.Take(0, 2, kDeviation_m);
  EXPECT_EQ(depths.Take(1, 5, kDeviation_m).depth_m, 5) << "another ray";
  const SteadyDepths::Mean there = depths.Take(0, 2.09, kDeviation_m);
  EXPECT_EQ(there.depth_m, 2.09);
  EXPECT_EQ(there.count, 1);
}

TEST(SteadyDepths, KnowAWallAgainBeforeWhichSomethingHasPassed) {
  SteadyDepths depths(60);
  for (int n = 0; n < 30; ++n) EXPECT_FALSE(depths.Take(0, 2, kDeviation_m).has_jumped);
  for (int n = 0; n < 10; ++n) EXPECT_TRUE(depths.Take(0, 1.5, kDeviation_m).has_jumped);
  SteadyDepths::Mean again = depths.Take(0, 2.03, kDeviation_m);
  EXPECT_EQ(again.count, 31);
  EXPECT_NEAR(again.depth_m, 2 + 0.03 / 31, 1e-12);
  EXPECT_FALSE(again.has_jumped);
  EXPECT_TRUE(depths.Take(0, 1.5, kDeviation_m).has_jumped);
  // What stays for longer is the wall.
  for (int n = 0; n < 60; ++n) depths.Take(0, 1.5, kDeviation_m);
  EXPECT_TRUE(depths.Take(0, 2, kDeviation_m).has_jumped);
  again = depths.Take(0, 1.5, kDeviation_m);
  EXPECT_EQ(again.count, 60);
  EXPECT_EQ(again.depth_m, 1.5);
  EXPECT_FALSE(again.has_jumped);
}

TEST(SteadyDepths, AreNeverFarBehindWhatCreeps) {
  for (const double step_m : {0.0005, 0.002, 0.005, 0.01, 0.03, 0.2}) {
    for (const double way : {-1, 1}) {
      SteadyDepths depths(60);
      for (int n = 0; n < 300; ++n) {
        const double depth_m = 3 + way * step_m * n;
        const double behind_m = std::abs(depths.Take(0, depth_m, kDeviation_m).depth_m - depth_m);
        ASSERT_LT(behind_m, 1.7 * kDeviation_m) << step_m << " a scan, scan " << n;
      }
    }
  }
}

TEST(SteadyDepths, LeaveWhatIsExactAsItIs) {
  SteadyDepths depths(60);
  for (const double depth_m : {2.0, 2.0, 2.001}) {
    EXPECT_EQ(depths.Take(0, depth_m, 0).depth_m, depth_m);
  }
  EXPECT_THROW(SteadyDepths(0), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::sdf::steady_depths_test
