#include "sidestep/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace sidestep::random_test {
namespace {

TEST(RandomStream, IsDecidedBySeedAndPurpose) {
  const auto first = [](std::uint64_t seed, std::string_view purpose) {
    return RandomStream(seed, purpose).Bits();
  };
  EXPECT_EQ(first(1, "jitter"), first(1, "jitter"));
  EXPECT_NE(first(1, "jitter"), first(2, "jitter"));
  EXPECT_NE(first(1, "jitter"), first(1, "dropout"));
}

// Computed by a program of its own in Python, whose floating-point numbers are those of IEEE 754.
TEST(RandomStream, GivesTheSameBitsEverywhere) {
  RandomStream bits(7, "test");
  for (const std::uint64_t expected :
       {0x12631694837bb244u, 0x2e9423cb9f3025e5u, 0xd49bacc811c71bb0u}) {
    EXPECT_EQ(bits.Bits(), expected);
  }
  RandomStream uniform(7, "test");
  for (const double expected : {0x1.2631694837bb0p-4, 0x1.74a11e5cf9810p-3, 0x1.a9375990238e3p-1}) {
    EXPECT_EQ(uniform.Uniform(), expected);
  }
  RandomStream normal(7, "test");
  for (const double expected :
       {0x1.47e414fd87aebp-3, 0x1.d1b64f90a6071p+0, -0x1.c04c04d3a27bfp+0, 0x1.486d800f468acp-1}) {
    EXPECT_EQ(normal.Normal(), expected);
  }
}

TEST(RandomStream, NormalNumbersAreThoseOfBoxAndMuller) {
  RandomStream random(1, "test"), same(1, "test");
  for (int i = 0; i < 100000; ++i) {
    const double radius = std::sqrt(-2 * std::log(1 - same.Uniform()));
    const double expected = radius * std::cos(2 * M_PI * same.Uniform());
    ASSERT_NEAR(random.Normal(), expected, 1e-14);
  }
}

TEST(RandomStream, UniformNumbersOfARangeFillThatRange) {
  RandomStream random(3, "test");
  double least = 9, most = -9, sum = 0;
  for (int i = 0; i < 10000; ++i) {
    const double x = random.Uniform(-2, 5);
    least = std::min(least, x);
    most = std::max(most, x);
    sum += x;
  }
  EXPECT_NEAR(least, -2, 0.01);
  EXPECT_NEAR(most, 5, 0.01);
  EXPECT_NEAR(sum / 10000, 1.5, 4 * 7 / std::sqrt(12.0 * 10000));
  EXPECT_GE(least, -2);
  EXPECT_LE(most, 5);
}

TEST(RandomStream, UniformNumbersFillTheirIntervalEvenly) {
  constexpr int kBins = 20, kDraws = 200000;
  RandomStream random(3, "test");
  std::vector<int> counts(kBins, 0);
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.Uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ++counts[static_cast<std::size_t>(u * kBins)];
  }
  double chi2 = 0;
  for (const int count : counts) chi2 += std::pow(count - kDraws / kBins, 2) * kBins / kDraws;
  EXPECT_LT(chi2, 43.8);  // the 0.999 quantile at 19 degrees of freedom
  EXPECT_GT(chi2, 5.4);   // and the 0.001
}

TEST(RandomStream, NormalNumbersHaveTheMomentsAndTailsOfANormalDistribution) {
  constexpr int kDraws = 200000;
  RandomStream random(3, "test");
  double sum = 0, sum2 = 0, sum4 = 0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    sum += x;
    sum2 += x * x;
    sum4 += x * x * x * x;
    if (std::abs(x) > 2) ++beyond_two;
  }
  // Each within four standard errors.
  EXPECT_NEAR(sum / kDraws, 0, 4 / std::sqrt(kDraws));
  EXPECT_NEAR(sum2 / kDraws, 1, 4 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(sum4 / kDraws, 3, 4 * std::sqrt(96.0 / kDraws));
  const double tail = std::erfc(std::sqrt(2.0));
  EXPECT_NEAR(beyond_two, tail * kDraws, 4 * std::sqrt(tail * kDraws));
}

}  // namespace
}  // namespace sidestep::random_test
