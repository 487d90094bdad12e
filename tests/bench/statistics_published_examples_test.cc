// Statistics against worked examples of the literature and against brute force.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "sidestep/bench/statistics/proportions.h"
#include "sidestep/bench/statistics/resampling.h"
#include "sidestep/bench/statistics/signed_rank.h"

namespace sidestep::bench::statistics_published_examples_test {
namespace {

TEST(WilsonInterval, GivesNewcombesFigures) {
  // Newcombe, Statistics in Medicine 17:857-872, 1998, table I, method 3.
  struct Example {
    int successes, trials;
    double low, high;
  };
  for (const Example& example : {Example{81, 263, 0.2553, 0.3662},
                                 {15, 148, 0.0624, 0.1605},
                                 {0, 20, 0, 0.1611},
                                 {1, 29, 0.0061, 0.1718}}) {
    const Interval interval = WilsonInterval(example.successes, example.trials);
    EXPECT_NEAR(interval.low, example.low, 5e-5) << example.successes;
    EXPECT_NEAR(interval.high, example.high, 5e-5) << example.successes;
  }
  EXPECT_THROW(WilsonInterval(0, 0), std::invalid_argument);
  EXPECT_THROW(WilsonInterval(3, 2), std::invalid_argument);
}

TEST(McNemarExactP, GivesTheFigureOfAirwayHyperResponsiveness) {
  // Fagerland, Lydersen & Laake, BMC Med Res Methodol 13:91, 2013: 1 against 7 pairs, p = 0.0703.
  EXPECT_NEAR(McNemarExactP(1, 7), 18.0 / 256, 1e-12);
  EXPECT_EQ(McNemarExactP(1, 7), McNemarExactP(7, 1));
}

TEST(McNemarExactP, IsOneWhereNothingDiffers) {
  EXPECT_EQ(McNemarExactP(0, 0), 1);
  EXPECT_EQ(McNemarExactP(4, 4), 1);
  EXPECT_NEAR(McNemarExactP(0, 300), std::pow(2.0, -299), 1e-12 * std::pow(2.0, -299));
}

TEST(SignedRanks, GiveTheFiguresOfHamiltonsDepressionScale) {
  // Hollander & Wolfe 1999, example 3.1: nine patients before and after tranquillisers. V = 40,
  // two-sided p = 0.0391, the estimate of the shift 0.46.
  const std::vector<double> before = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const std::vector<double> after = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> differences;
  for (std::size_t i = 0; i < before.size(); ++i) differences.push_back(before[i] - after[i]);
  const SignedRankResult result = TestSignedRanks(differences);
  EXPECT_EQ(result.positive_rank_sum, 40);
  EXPECT_NEAR(result.p, 20.0 / 512, 1e-12);
  EXPECT_NEAR(result.shift, 0.46, 5e-3);
}

TEST(SignedRanks, CountTiesAndZerosAsBruteForceDoes) {
  const std::vector<double> differences = {1, -1, 2, 0, 2, 2, 0, 3, -3, 5};
  const std::vector<double> doubled_ranks = {3, 3, 8, 8, 8, 13, 13, 16};  // of the eight others
  const double observed = 3 + 8 + 8 + 8 + 13 + 16;
  const double half = (3 + 3 + 8 + 8 + 8 + 13 + 13 + 16) / 2.0;
  int as_extreme = 0;
  for (unsigned signs = 0; signs < 256; ++signs) {
    double sum = 0;
    for (std::size_t i = 0; i < 8; ++i) sum += (signs >> i & 1) != 0 ? doubled_ranks[i] : 0;
    as_extreme += std::abs(sum - half) >= observed - half ? 1 : 0;
  }
  const SignedRankResult result = TestSignedRanks(differences);
  EXPECT_EQ(result.num_differences, 8);
  EXPECT_EQ(result.num_zero, 2);
  EXPECT_EQ(result.positive_rank_sum, observed / 2);
  EXPECT_NEAR(result.p, as_extreme / 256.0, 1e-12);
}

TEST(SignedRanks, SayNothingWithoutDifferences) {
  EXPECT_EQ(TestSignedRanks({0, 0}).p, 1);
  EXPECT_EQ(TestSignedRanks({}).p, 1);
  EXPECT_TRUE(std::isnan(TestSignedRanks({}).shift));
  EXPECT_THROW(TestSignedRanks({std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

TEST(HolmAdjusted, StepsDownAndKeepsTheOrderGiven) {
  // R: p.adjust(c(0.04, 0.01, 0.03, 0.05, 0.02), "holm").
  const std::vector<double> expected = {0.09, 0.05, 0.09, 0.09, 0.08};
  const std::vector<double> adjusted = HolmAdjusted({0.04, 0.01, 0.03, 0.05, 0.02});
  ASSERT_EQ(adjusted.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-12);
  EXPECT_EQ(HolmAdjusted({0.6, 0.9}), (std::vector<double>{1, 1}));
  EXPECT_THROW(HolmAdjusted({1.5}), std::invalid_argument);
}

TEST(Bootstrap, GivesTheNormalIntervalOfAMeanOfManyClusters) {
  constexpr int kClusters = 400;
  const auto mean = [](const std::vector<int>& sample) {
    double sum = 0;
    for (const int cluster : sample) sum += cluster % 20;
    return sum / static_cast<double>(sample.size());
  };
  // Uniform on 0 ... 19: mean 9.5, variance 399 / 12.
  const double half = 1.96 * std::sqrt(399.0 / 12 / kClusters);
  const Interval interval = BootstrapOverClusters(kClusters, mean, 4000, 1);
  EXPECT_NEAR(interval.low, 9.5 - half, 0.08);
  EXPECT_NEAR(interval.high, 9.5 + half, 0.08);
  const Interval again = BootstrapOverClusters(kClusters, mean, 4000, 1);
  EXPECT_EQ(interval.low, again.low);
  EXPECT_NE(interval.low, BootstrapOverClusters(kClusters, mean, 4000, 2).low);
  EXPECT_THROW(BootstrapOverClusters(0, mean, 10, 1), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::bench::statistics_published_examples_test
