#include "sidestep/bench/statistics/paired_rates.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <stdexcept>

#include "sidestep/bench/statistics/resampling.h"

namespace sidestep::bench {
namespace {

constexpr double kMostExactSteps = 1e8;

struct Cluster {
  int pairs = 0, difference = 0;
};

Interval BootstrapInterval(const std::vector<Cluster>& clusters) {
  const auto difference = [&](const std::vector<int>& sample) {
    double pairs = 0, sum = 0;
    for (const int c : sample) {
      pairs += clusters[static_cast<std::size_t>(c)].pairs;
      sum += clusters[static_cast<std::size_t>(c)].difference;
    }
    return sum / pairs;
  };
  return BootstrapOverClusters(static_cast<int>(clusters.size()), difference, kBootstrapDraws,
                               kBootstrapSeed);
}

}  // namespace

Interval NewcombePairedInterval(int both, int only_first, int only_second, int neither) {
  if (std::min({both, only_first, only_second, neither}) < 0) {
    throw std::invalid_argument("NewcombePairedInterval: counts must be >= 0");
  }
  const int n = both + only_first + only_second + neither;
  const int first = both + only_first, second = both + only_second;
  const Interval of_first = WilsonInterval(first, n), of_second = WilsonInterval(second, n);
  const double p1 = static_cast<double>(first) / n, p2 = static_cast<double>(second) / n;
  const double margins =
      static_cast<double>(first) * (n - first) * static_cast<double>(second) * (n - second);
  double correlation = 0;
  if (margins > 0) {
    const double cross =
        static_cast<double>(both) * neither - static_cast<double>(only_first) * only_second;
    const double corrected = cross > 0 ? std::max(cross - n / 2.0, 0.0) : cross;
    correlation = corrected / std::sqrt(margins);
  }
  const auto reach = [correlation](double a, double b) {
    return std::sqrt(std::max(0.0, a * a - 2 * correlation * a * b + b * b));
  };
  const double difference = p1 - p2;
  return {difference - reach(p1 - of_first.low, of_second.high - p2),
          difference + reach(of_first.high - p1, p2 - of_second.low)};
}

double SignFlipP(const std::vector<int>& differences) {
  int observed = 0;
  long total = 0;
  double squares = 0;
  std::vector<int> steps;
  for (const int difference : differences) {
    observed += difference;
    if (difference == 0) continue;
    steps.push_back(std::abs(difference));
    total += steps.back();
    squares += static_cast<double>(difference) * difference;
  }
  observed = std::abs(observed);
  if (observed == 0) return 1;
  if (static_cast<double>(total) * static_cast<double>(steps.size()) > kMostExactSteps) {
    return std::erfc(observed / std::sqrt(2 * squares));
  }
  // How likely the sum of the positive ones is s: the sum of all is 2 s - total.
  std::vector<double> chance(static_cast<std::size_t>(total) + 1, 0.0);
  chance[0] = 1;
  std::size_t reached = 0;
  for (const int step : steps) {
    const auto by = static_cast<std::size_t>(step);
    reached += by;
    for (std::size_t s = reached + 1; s-- > 0;) {
      chance[s] = 0.5 * (chance[s] + (s >= by ? chance[s - by] : 0.0));
    }
  }
  double tail = 0;
  for (long s = 0; s <= (total - observed) / 2; ++s) tail += chance[static_cast<std::size_t>(s)];
  return std::min(1.0, 2 * tail);
}

PairedRates ComparePairedRates(const std::vector<PairedOutcome>& pairs) {
  if (pairs.empty()) throw std::invalid_argument("ComparePairedRates: no pairs");
  PairedRates rates;
  std::map<int, Cluster> by_cluster;
  for (const PairedOutcome& pair : pairs) {
    ++rates.num_pairs;
    rates.first_successes += pair.first ? 1 : 0;
    rates.second_successes += pair.second ? 1 : 0;
    rates.only_first += pair.first && !pair.second ? 1 : 0;
    rates.only_second += pair.second && !pair.first ? 1 : 0;
    Cluster& cluster = by_cluster[pair.cluster];
    ++cluster.pairs;
    cluster.difference += static_cast<int>(pair.first) - static_cast<int>(pair.second);
  }
  std::vector<Cluster> clusters;
  std::vector<int> differences;
  for (const auto& [name, cluster] : by_cluster) {
    clusters.push_back(cluster);
    differences.push_back(cluster.difference);
  }
  rates.num_clusters = static_cast<int>(clusters.size());
  rates.difference = static_cast<double>(rates.only_first - rates.only_second) / rates.num_pairs;
  rates.p = SignFlipP(differences);
  rates.least_p = std::min(1.0, std::exp2(1 - rates.num_clusters));

  const int both = rates.first_successes - rates.only_first;
  const int neither = rates.num_pairs - both - rates.only_first - rates.only_second;
  const bool is_each_one_pair = rates.num_clusters == rates.num_pairs;
  const bool all_agree = std::all_of(clusters.begin(), clusters.end(), [&](const Cluster& c) {
    return static_cast<long>(c.difference) * clusters.front().pairs ==
           static_cast<long>(clusters.front().difference) * c.pairs;
  });
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (is_each_one_pair) {
    rates.interval = NewcombePairedInterval(both, rates.only_first, rates.only_second, neither);
  } else if (rates.num_clusters == 1) {
    rates.interval = {kUnknown, kUnknown};
  } else if (all_agree) {
    // A bootstrap would be sure. As if each cluster were one pair, in their proportion.
    const auto scaled = [&](int count) {
      return static_cast<int>(
          std::lround(static_cast<double>(count) * rates.num_clusters / rates.num_pairs));
    };
    const int first = scaled(rates.only_first), second = scaled(rates.only_second);
    const int agreed = std::max(0, rates.num_clusters - first - second);
    const int succeeded = std::min(scaled(both), agreed);
    rates.interval = NewcombePairedInterval(succeeded, first, second, agreed - succeeded);
  } else {
    rates.interval = BootstrapInterval(clusters);
  }
  return rates;
}

}  // namespace sidestep::bench
