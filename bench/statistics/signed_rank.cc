#include "sidestep/bench/statistics/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sidestep/bench/statistics/pairwise_means.h"

namespace sidestep::bench {
namespace {

// Of differences that are ranked: the exact distribution takes about a second.
constexpr std::size_t kMostExact = 1000;

// Twice the rank of each value, which is whole with ties too.
std::vector<std::size_t> DoubledRanks(const std::vector<double>& sorted) {
  std::vector<std::size_t> ranks(sorted.size());
  for (std::size_t begin = 0; begin < sorted.size();) {
    std::size_t end = begin;
    while (end < sorted.size() && sorted[end] == sorted[begin]) ++end;
    std::fill(ranks.begin() + static_cast<std::ptrdiff_t>(begin),
              ranks.begin() + static_cast<std::ptrdiff_t>(end), begin + end + 1);
    begin = end;
  }
  return ranks;
}

// The probability of each sum of a random half of the ranks.
std::vector<double> NullDistribution(const std::vector<std::size_t>& ranks) {
  std::vector<double> probability = {1};
  for (const std::size_t rank : ranks) {
    std::vector<double> next(probability.size() + rank, 0);
    for (std::size_t sum = 0; sum < probability.size(); ++sum) {
      next[sum] += probability[sum] / 2;
      next[sum + rank] += probability[sum] / 2;
    }
    probability = std::move(next);
  }
  return probability;
}

double ExactP(std::size_t positive, const std::vector<std::size_t>& ranks) {
  const std::vector<double> probability = NullDistribution(ranks);
  const std::size_t nearer = std::min(positive, probability.size() - 1 - positive);
  double tail = 0;
  for (std::size_t sum = 0; sum <= nearer; ++sum) tail += probability[sum];
  return std::min(1.0, 2 * tail);
}

// By the normal distribution of the same mean and variance, the ties' ranks included, with a
// correction for continuity.
double NormalP(std::size_t positive, const std::vector<std::size_t>& ranks) {
  double sum = 0, sum_of_squares = 0;
  for (const std::size_t doubled : ranks) {
    const double rank = static_cast<double>(doubled) / 2;
    sum += rank;
    sum_of_squares += rank * rank;
  }
  const double away = std::abs(static_cast<double>(positive) / 2 - sum / 2);
  const double z = std::max(0.0, away - 0.5) / std::sqrt(sum_of_squares / 4);
  return std::min(1.0, std::erfc(z / std::sqrt(2.0)));
}

}  // namespace

SignedRankResult TestSignedRanks(const std::vector<double>& differences) {
  SignedRankResult result;
  std::vector<double> ranked;
  for (const double difference : differences) {
    if (!std::isfinite(difference)) {
      throw std::invalid_argument("TestSignedRanks: differences must be finite");
    }
    if (difference != 0) ranked.push_back(difference);
  }
  result.num_differences = static_cast<int>(ranked.size());
  result.num_zero = static_cast<int>(differences.size() - ranked.size());
  result.shift = MedianOfPairwiseMeans(differences);
  std::sort(ranked.begin(), ranked.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });
  std::vector<double> sizes;
  for (const double difference : ranked) sizes.push_back(std::abs(difference));
  const std::vector<std::size_t> ranks = DoubledRanks(sizes);
  std::size_t positive = 0;
  for (std::size_t i = 0; i < ranked.size(); ++i) positive += ranked[i] > 0 ? ranks[i] : 0;
  result.positive_rank_sum = static_cast<double>(positive) / 2;

  result.p = ranks.size() <= kMostExact ? ExactP(positive, ranks) : NormalP(positive, ranks);
  return result;
}

}  // namespace sidestep::bench
