#include "sidestep/bench/statistics/paired_medians.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/statistics/resampling.h"

namespace sidestep::bench {
namespace {

constexpr int kMostDraws = 2000, kFewestDraws = 200;
constexpr double kMostDrawnPairs = 2e7;

double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

// The middle of many, by selection.
double FastMedian(std::vector<double>& values) {
  if (values.empty()) return kNaN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

PairedMedians ComparePairedMedians(const std::vector<PairedNumber>& pairs) {
  PairedMedians medians;
  medians.num_pairs = static_cast<int>(pairs.size());
  std::vector<double> first, second, differences;
  std::map<int, std::vector<double>> by_cluster;
  for (const PairedNumber& pair : pairs) {
    first.push_back(pair.first);
    second.push_back(pair.second);
    differences.push_back(pair.first - pair.second);
    by_cluster[pair.cluster].push_back(differences.back());
  }
  medians.first = Median(first);
  medians.second = Median(second);
  medians.difference = Median(differences);
  medians.interval = {kNaN, kNaN};
  if (by_cluster.size() < 2) return medians;
  std::vector<const std::vector<double>*> clusters;
  for (const auto& [name, values] : by_cluster) clusters.push_back(&values);
  const auto median = [&](const std::vector<int>& sample) {
    std::vector<double> drawn;
    drawn.reserve(differences.size());
    for (const int c : sample) {
      const std::vector<double>& values = *clusters[static_cast<std::size_t>(c)];
      drawn.insert(drawn.end(), values.begin(), values.end());
    }
    return FastMedian(drawn);
  };
  const int draws =
      std::clamp(static_cast<int>(kMostDrawnPairs / static_cast<double>(pairs.size())),
                 kFewestDraws, kMostDraws);
  medians.interval =
      BootstrapOverClusters(static_cast<int>(clusters.size()), median, draws, kBootstrapSeed);
  return medians;
}

}  // namespace sidestep::bench
