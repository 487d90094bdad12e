#pragma once

#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/open_loop_outcomes.h"
#include "sidestep/bench/statistics/paired_comparison.h"
#include "sidestep/bench/statistics/proportions.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {

/// How often runs under one kind of knowledge are collision-free, and what they cost.
struct FreeRate {
  sdf::Knowledge knowledge = sdf::Knowledge::kStatic;
  double speed_m_s = 0;  ///< not used where all speeds are pooled
  int num_rows = 0, num_free = 0;
  Interval wilson;          ///< 95 %, as if rows were independent, which they are within a speed
  double mean_gp_cost = 0;  ///< of all rows; NaN if one is not finite
};

/// Two kinds of knowledge: success is to be collision-free, the cost is the GP cost; levels are
/// speeds, clusters pairs of start and goal.
struct KnowledgeComparison : PairedComparison {
  sdf::Knowledge first = sdf::Knowledge::kStatic, second = sdf::Knowledge::kStatic;
};

/// Everything that a table of results says, under one filter.
struct OpenLoopStatistics {
  RowFilter filter = RowFilter::kAllRows;
  int num_rows = 0, excluded_by_speed = 0, excluded_none_free = 0;
  std::vector<FreeRate> pooled;    ///< one a kind of knowledge
  std::vector<FreeRate> by_speed;  ///< by knowledge, then by speed
  std::vector<KnowledgeComparison> comparisons;
};

/// By knowledge, then by speed.
std::vector<FreeRate> FreeRatesBySpeed(const std::vector<MatchedOutcomes>& rows);

/// Deterministic. A kind of knowledge is compared in the rows that have it. No rates and
/// comparisons if no row is left.
OpenLoopStatistics ComputeOpenLoopStatistics(const std::vector<MatchedOutcomes>& rows,
                                             RowFilter filter,
                                             const OpenLoopExperiment& experiment);

}  // namespace sidestep::bench
