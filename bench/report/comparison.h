#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/report/run_table.h"
#include "sidestep/bench/statistics/paired_medians.h"
#include "sidestep/bench/statistics/paired_rates.h"

namespace sidestep::bench {

/// Two levels of a factor, by their places.
struct Question {
  int factor = -1;  ///< none
  int of = 0, with = 0;
};

/// A number of runs at both levels: `of` comes first.
struct MetricComparison : PairedMedians {
  std::string column;
};

/// The same cases under two levels of a factor.
struct Comparison {
  Question question;
  PairedRates rates;     ///< of reaching the goal and touching nothing
  int num_left_out = 0;  ///< pairs of which a run failed: nothing is known of it
  int num_unpaired = 0;  ///< runs at these levels whose like is missing
  bool by_seed = false;  ///< pairs of one seed are a cluster; else each pair is one
  std::vector<MetricComparison> metrics;
};

struct ComparedMetric {
  std::string column;       ///< of the table
  bool goals_only = false;  ///< only pairs that both reached the goal count
};

/// Compares runs that agree in everything but the factor. Clusters are seeds, or, if there is only
/// one, pairs.
Comparison Compare(const RunTable& runs, const Question& question,
                   const std::vector<ComparedMetric>& metrics);

/// The pairs of it: of runs by their places, of and with.
std::vector<std::pair<std::size_t, std::size_t>> PairsOf(const RunTable& runs,
                                                         const Question& question);

}  // namespace sidestep::bench
