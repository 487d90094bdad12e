#include "sidestep/core/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sidestep {
namespace {

TEST(RandomStream, IsDecidedBySeedAndPurpose) {
  const auto first = [](std::uint64_t seed, std::string_view purpose) {
    return RandomStream(seed, purpose).Bits();
  };
  EXPECT_EQ(first(1, "jitter"), first(1, "jitter"));
  EXPECT_NE(first(1, "jitter"), first(2, "jitter"));
  EXPECT_NE(first(1, "jitter"), first(1, "dropout"));
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
}  // namespace sidestep
