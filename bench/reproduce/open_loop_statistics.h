#pragma once

#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/open_loop_outcomes.h"
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

/// GP costs of matched runs, first minus second.
struct CostComparison {
  int num_rows = 0;
  int num_not_finite = 0;  ///< rows that could not be compared
  double shift = 0;        ///< Hodges and Lehmann's; NaN without rows
  double p = 1;            ///< Wilcoxon's signed ranks, exact
  double p_holm = 1;       ///< adjusted over the speeds of the comparison
};

/// Two kinds of knowledge at one speed, matched by start and goal.
struct SpeedComparison {
  double speed_m_s = 0;
  int num_rows = 0;
  int only_first_free = 0, only_second_free = 0;
  double mcnemar_p = 1, mcnemar_p_holm = 1;
  CostComparison all, both_free;  ///< of all rows; of those in which both are collision-free
};

/// Two kinds of knowledge over all speeds. Rows of one start and goal resemble each other, so
/// intervals (95 %) come from a bootstrap over starts and goals, and there is no pooled test.
struct KnowledgeComparison {
  sdf::Knowledge first = sdf::Knowledge::kStatic, second = sdf::Knowledge::kStatic;
  int num_rows = 0;
  int only_first_free = 0, only_second_free = 0;
  double rate_difference = 0;  ///< of the share of collision-free rows, first minus second
  Interval rate_interval;
  double median_cost_difference = 0;  ///< first minus second, of finite ones; NaN without any
  Interval cost_interval;
  std::vector<SpeedComparison> speeds;
};

/// Everything that a table of results says, under one filter.
struct OpenLoopStatistics {
  RowFilter filter = RowFilter::kAllRows;
  int num_rows = 0, excluded_by_speed = 0, excluded_none_free = 0;
  std::vector<FreeRate> pooled;    ///< one a kind of knowledge
  std::vector<FreeRate> by_speed;  ///< by knowledge, then by speed
  std::vector<KnowledgeComparison> comparisons;
};

/// Deterministic: the bootstrap has a fixed seed. A kind of knowledge is compared in the rows that
/// have it. No rates and comparisons if no row is left.
OpenLoopStatistics ComputeOpenLoopStatistics(const std::vector<MatchedOutcomes>& rows,
                                             RowFilter filter,
                                             const OpenLoopExperiment& experiment);

}  // namespace sidestep::bench
