#include "sidestep/bench/statistics/pairwise_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/statistics/signed_rank.h"
#include "sidestep/core/random.h"

namespace sidestep::bench::pairwise_means_test {
namespace {

// Makes every mean.
double BruteForce(const std::vector<double>& values) {
  std::vector<double> means;
  for (std::size_t i = 0; i < values.size(); ++i) {
    for (std::size_t j = i; j < values.size(); ++j) means.push_back((values[i] + values[j]) / 2);
  }
  return Quantile(means, 0.5);
}

TEST(MedianOfPairwiseMeans, IsThatOfAllMeansWithTiesAndZerosToo) {
  for (int n = 1; n <= 60; ++n) {
    RandomStream random(static_cast<std::uint64_t>(n), "means");
    std::vector<double> smooth, tied, wide;
    for (int i = 0; i < n; ++i) {
      smooth.push_back(random.Normal());
      tied.push_back(std::floor(random.Uniform(-3, 3)) / 10);
      wide.push_back(std::ldexp(random.Normal(), static_cast<int>(random.Uniform(-60, 60))));
    }
    for (const std::vector<double>& values : {smooth, tied, wide}) {
      EXPECT_DOUBLE_EQ(MedianOfPairwiseMeans(values), BruteForce(values)) << n;
    }
  }
  EXPECT_EQ(MedianOfPairwiseMeans({-0.0, 0.0}), 0);
  EXPECT_TRUE(std::isnan(MedianOfPairwiseMeans({})));
}

// 40 GB, if every mean were made.
TEST(MedianOfPairwiseMeans, TakesAHundredThousandValues) {
  RandomStream random(1, "many");
  std::vector<double> values;
  for (int i = 0; i < 100'000; ++i) values.push_back(0.3 + random.Normal());
  EXPECT_NEAR(MedianOfPairwiseMeans(values), 0.3, 0.02);
  const SignedRankResult result = TestSignedRanks(values);
  EXPECT_EQ(result.num_differences, 100'000);
  EXPECT_LT(result.p, 1e-6);
}

// The normal approximation goes on where the exact distribution ends.
TEST(SignedRanks, HaveTheSamePOnBothSidesOfTheirLimit) {
  for (const double shift : {0.0, 0.02, 0.05, 0.1}) {
    RandomStream random(7, "p");
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i)
      values.push_back(std::floor(200 * (shift + random.Normal())) + 0.5);
    const double exact = TestSignedRanks(values).p;
    values.push_back(0.5);  // nearly nothing
    const double normal = TestSignedRanks(values).p;
    EXPECT_NEAR(normal, exact, 0.02 * exact + 2e-3) << shift;
  }
}

}  // namespace
}  // namespace sidestep::bench::pairwise_means_test
