#include "sidestep/bench/statistics/paired_rates.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "sidestep/core/random.h"

namespace sidestep::bench::paired_rates_test {
namespace {

TEST(NewcombePairedInterval, GivesTheFiguresOfAirwayHyperResponsiveness) {
  // Fagerland, Lydersen & Laake, "Recommended tests and confidence intervals for paired binomial
  // proportions", Statistics in Medicine 33:2850-2875, 2014: 1, 1, 7 and 12 of 21 pairs.
  const Interval interval = NewcombePairedInterval(1, 1, 7, 12);
  EXPECT_NEAR(interval.low, -0.507, 5e-4);
  EXPECT_NEAR(interval.high, -0.026, 5e-4);
}

TEST(NewcombePairedInterval, IsTurnedRoundWithTheTreatments) {
  const Interval one = NewcombePairedInterval(5, 3, 9, 4),
                 other = NewcombePairedInterval(5, 9, 3, 4);
  EXPECT_NEAR(one.low, -other.high, 1e-12);
  EXPECT_NEAR(one.high, -other.low, 1e-12);
  EXPECT_THROW(NewcombePairedInterval(0, 0, 0, 0), std::invalid_argument);
  EXPECT_THROW(NewcombePairedInterval(1, -1, 0, 0), std::invalid_argument);
}

TEST(NewcombePairedInterval, HoldsTheTrueDifferenceAsOftenAsItSays) {
  RandomStream random(1, "pairs");
  int held = 0;
  constexpr int kRepeats = 4000;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    int counts[4] = {0, 0, 0, 0};  // both 0.5, only first 0.3, only second 0.1, neither 0.1
    for (int pair = 0; pair < 40; ++pair) {
      const double u = random.Uniform();
      ++counts[u < 0.5 ? 0 : u < 0.8 ? 1 : u < 0.9 ? 2 : 3];
    }
    const Interval interval = NewcombePairedInterval(counts[0], counts[1], counts[2], counts[3]);
    held += interval.low <= 0.2 && 0.2 <= interval.high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(held) / kRepeats, 0.95, 0.015);
}

double BruteForceP(const std::vector<int>& differences) {
  int observed = 0, extreme = 0;
  for (const int d : differences) observed += d;
  const int ways = 1 << differences.size();
  for (int signs = 0; signs < ways; ++signs) {
    int sum = 0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
      sum += (signs >> i & 1) != 0 ? differences[i] : -differences[i];
    }
    extreme += std::abs(sum) >= std::abs(observed) ? 1 : 0;
  }
  return static_cast<double>(extreme) / ways;
}

TEST(SignFlipP, CountsAsBruteForceDoes) {
  for (const std::vector<int>& differences : std::vector<std::vector<int>>{
           {}, {0}, {1}, {-3, 1}, {4, 4, 4, 4}, {2, -1, 0, 3, -2, 5}, {1, 1, 1, -1, 1, 0, 2, 7}}) {
    EXPECT_NEAR(SignFlipP(differences), BruteForceP(differences), 1e-12) << differences.size();
  }
}

TEST(SignFlipP, IsMcNemarsWhereEachDifferenceIsOne) {
  for (const auto& [first, second] : {std::pair{1, 7}, {12, 3}, {5, 5}, {0, 30}}) {
    std::vector<int> differences(static_cast<std::size_t>(first), 1);
    differences.insert(differences.end(), static_cast<std::size_t>(second), -1);
    EXPECT_NEAR(SignFlipP(differences), McNemarExactP(first, second), 1e-12);
  }
}

TEST(SignFlipP, IsNearlyTheSameWhereThereAreTooManyToCount) {
  RandomStream random(2, "differences");
  std::vector<int> some, many;
  for (int i = 0; i < 20000; ++i) {
    const int d = random.Uniform() < 0.507 ? 3 : -3;
    many.push_back(d);
    if (i < 4000) some.push_back(d);
  }
  int sum = 0;
  for (const int d : some) sum += d;
  EXPECT_NEAR(SignFlipP(some), std::erfc(std::abs(sum) / std::sqrt(2.0 * 9 * 4000)), 0.02);
  EXPECT_GT(SignFlipP(many), 0);
  EXPECT_LT(SignFlipP(many), 1);
}

std::vector<PairedOutcome> Pairs(int count, int per_cluster, bool first, bool second) {
  std::vector<PairedOutcome> pairs;
  for (int i = 0; i < count; ++i) pairs.push_back({i / per_cluster, first, second});
  return pairs;
}

TEST(PairedRates, AreNotSureOfWhatFewClustersAgreeIn) {
  const PairedRates rates = ComparePairedRates(Pairs(16, 4, true, false));
  EXPECT_EQ(rates.num_clusters, 4);
  EXPECT_EQ(rates.difference, 1);
  EXPECT_LT(rates.interval.low, 0.6);  // as four pairs
  EXPECT_EQ(rates.p, 0.125);
  EXPECT_EQ(rates.least_p, 0.125);
}

TEST(PairedRates, KnowNoIntervalOfOneCluster) {
  EXPECT_TRUE(std::isnan(ComparePairedRates(Pairs(5, 5, true, false)).interval.low));
  EXPECT_FALSE(std::isnan(ComparePairedRates(Pairs(1, 1, true, false)).interval.low));
  EXPECT_THROW(ComparePairedRates({}), std::invalid_argument);
}

TEST(PairedRates, WidenWherePairsOfAClusterResembleEachOther) {
  std::vector<PairedOutcome> alike, apart;
  for (int i = 0; i < 60; ++i) {
    const bool first_only = i / 6 % 2 == 0;
    alike.push_back({i / 6, first_only, false});
    apart.push_back({i, first_only, false});
  }
  const Interval wide = ComparePairedRates(alike).interval,
                 narrow = ComparePairedRates(apart).interval;
  EXPECT_GT(wide.high - wide.low, 1.5 * (narrow.high - narrow.low));
  EXPECT_GT(ComparePairedRates(alike).p, ComparePairedRates(apart).p);
}

}  // namespace
}  // namespace sidestep::bench::paired_rates_test
