#include "sidestep/bench/statistics/paired_comparison.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

namespace sidestep::bench::paired_comparison_test {
namespace {

// So many cases at one level, each a cluster of its own, in which the first alone succeeds, at a
// cost that is lower by one.
std::vector<PairedCase> WonByTheFirst(int num_cases, double level) {
  std::vector<PairedCase> cases;
  for (int i = 0; i < num_cases; ++i) cases.push_back({i, level, true, false, 1.0 * i, i + 1.0});
  return cases;
}

TEST(PairedComparison, FindsWhatIsAlwaysSo) {
  const PairedComparison comparison = ComparePaired(WonByTheFirst(6, 0.5));
  EXPECT_EQ(comparison.only_first, 6);
  EXPECT_EQ(comparison.only_second, 0);
  EXPECT_EQ(comparison.rate_difference, 1);
  EXPECT_EQ(comparison.rate_interval.low, 1) << "it is the same in every sample";
  EXPECT_EQ(comparison.median_cost_difference, -1);
  ASSERT_EQ(comparison.levels.size(), 1u);
  EXPECT_EQ(comparison.levels[0].level, 0.5);
  EXPECT_DOUBLE_EQ(comparison.levels[0].mcnemar_p, 2.0 / 64);
  EXPECT_DOUBLE_EQ(comparison.levels[0].all.p, 2.0 / 64);
  EXPECT_EQ(comparison.CountSignificantOutcomes(), 1);
  EXPECT_EQ(comparison.CountSignificantCosts(&LevelComparison::all), 1);
  EXPECT_EQ(comparison.CountSignificantCosts(&LevelComparison::both_succeed), 0);
}

TEST(PairedComparison, KnowsWhenNothingCouldBeSignificant) {
  EXPECT_TRUE(ComparePaired(WonByTheFirst(6, 1)).CanBeSignificant()) << "2 / 64 < 0.05";
  EXPECT_FALSE(ComparePaired(WonByTheFirst(5, 1)).CanBeSignificant()) << "2 / 32 is not";
  std::vector<PairedCase> two_levels = WonByTheFirst(6, 1);
  for (const PairedCase& one : WonByTheFirst(6, 2)) two_levels.push_back(one);
  const PairedComparison comparison = ComparePaired(two_levels);
  EXPECT_FALSE(comparison.CanBeSignificant()) << "Holm doubles the least p-value";
  EXPECT_EQ(comparison.CountSignificantOutcomes(), 0);
}

TEST(PairedComparison, LeavesOutCostsThatAreNotFinite) {
  std::vector<PairedCase> cases = WonByTheFirst(3, 1);
  cases[0].second_cost = std::numeric_limits<double>::quiet_NaN();
  const PairedComparison comparison = ComparePaired(cases);
  EXPECT_EQ(comparison.num_rows, 3);
  EXPECT_EQ(comparison.levels.at(0).all.num_rows, 3);
  EXPECT_EQ(comparison.levels.at(0).all.num_not_finite, 1);
  EXPECT_EQ(comparison.median_cost_difference, -1);
}

TEST(PairedComparison, NeedsCases) { EXPECT_THROW(ComparePaired({}), std::invalid_argument); }

}  // namespace
}  // namespace sidestep::bench::paired_comparison_test
