#include "sidestep/bench/statistics/resampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "sidestep/bench/statistics.h"
#include "sidestep/core/random.h"

namespace sidestep::bench {

Interval BootstrapOverClusters(int num_clusters,
                               const std::function<double(const std::vector<int>&)>& statistic,
                               int num_draws, std::uint64_t seed, double coverage) {
  if (num_clusters < 1 || num_draws < 1 || !(coverage > 0 && coverage < 1)) {
    throw std::invalid_argument("BootstrapOverClusters: needs clusters, draws, 0 < coverage < 1");
  }
  RandomStream random(seed, "bootstrap");
  std::vector<int> sample(static_cast<std::size_t>(num_clusters));
  std::vector<double> values;
  for (int draw = 0; draw < num_draws; ++draw) {
    // The bias of the remainder is below 1e-15.
    for (int& cluster : sample) {
      cluster = static_cast<int>(random.Bits() % static_cast<std::uint64_t>(num_clusters));
    }
    const double value = statistic(sample);
    if (!std::isnan(value)) values.push_back(value);
  }
  return {Quantile(values, (1 - coverage) / 2), Quantile(values, (1 + coverage) / 2)};
}

std::vector<double> HolmAdjusted(const std::vector<double>& p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> adjusted(p_values.size());
  double least = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double p = p_values[order[i]];
    if (!(p >= 0 && p <= 1)) throw std::invalid_argument("HolmAdjusted: p must be in [0, 1]");
    least = std::max(least, std::min(1.0, static_cast<double>(order.size() - i) * p));
    adjusted[order[i]] = least;
  }
  return adjusted;
}

}  // namespace sidestep::bench
