#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sidestep/bench/statistics/proportions.h"

namespace sidestep::bench {

/// What comparisons of pairs draw, and from which seed.
inline constexpr int kBootstrapDraws = 2000;
inline constexpr std::uint64_t kBootstrapSeed = 1;

/// Percentile bootstrap over clusters: rows that belong together (all speeds of a start and goal)
/// are drawn together, because they are not independent. Deterministic for a seed.
/// @param statistic of a drawn sample of clusters, given by their indices, repeats included. Draws
/// whose statistic is NaN are left out.
/// @param coverage of the interval, in (0, 1).
/// Source: A. Davison, D. Hinkley, "Bootstrap Methods and their Application", 1997, section 3.8.
/// @throws std::invalid_argument without clusters or draws, or for a coverage out of range.
Interval BootstrapOverClusters(int num_clusters,
                               const std::function<double(const std::vector<int>&)>& statistic,
                               int num_draws, std::uint64_t seed, double coverage = 0.95);

/// Holm's step-down adjustment of p-values that are tested together, in the order given.
/// Source: S. Holm, "A simple sequentially rejective multiple test procedure", Scandinavian Journal
/// of Statistics 6:65-70, 1979.
/// @throws std::invalid_argument for a p-value outside [0, 1].
std::vector<double> HolmAdjusted(const std::vector<double>& p_values);

}  // namespace sidestep::bench
