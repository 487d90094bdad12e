#include "sidestep/bench/statistics/signed_rank.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sidestep/bench/statistics.h"

namespace sidestep::bench {
namespace {

double HodgesLehmann(const std::vector<double>& differences) {
  std::vector<double> means;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    for (std::size_t j = i; j < differences.size(); ++j) {
      means.push_back((differences[i] + differences[j]) / 2);
    }
  }
  return Quantile(std::move(means), 0.5);
}

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
  result.shift = HodgesLehmann(differences);
  std::sort(ranked.begin(), ranked.end(),
            [](double a, double b) { return std::abs(a) < std::abs(b); });
  std::vector<double> sizes;
  for (const double difference : ranked) sizes.push_back(std::abs(difference));
  const std::vector<std::size_t> ranks = DoubledRanks(sizes);
  std::size_t positive = 0;
  for (std::size_t i = 0; i < ranked.size(); ++i) positive += ranked[i] > 0 ? ranks[i] : 0;
  result.positive_rank_sum = static_cast<double>(positive) / 2;

  const std::vector<double> probability = NullDistribution(ranks);
  const std::size_t nearer = std::min(positive, probability.size() - 1 - positive);
  double tail = 0;
  for (std::size_t sum = 0; sum <= nearer; ++sum) tail += probability[sum];
  result.p = std::min(1.0, 2 * tail);
  return result;
}

}  // namespace sidestep::bench
