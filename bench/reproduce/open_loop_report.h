#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/reproduce/open_loop_outcomes.h"
#include "sidestep/bench/reproduce/open_loop_statistics.h"
#include "sidestep/bench/reproduce/open_loop_study.h"
#include "sidestep/bench/reproduce/published_table.h"

namespace sidestep::bench {

/// How many rows of a kind of knowledge the verdicts call collision-free.
struct VerdictCounts {
  sdf::Knowledge knowledge = sdf::Knowledge::kStatic;
  int num_rows = 0;
  int free = 0;               ///< verdict published_states
  int truly_free_states = 0;  ///< of these, clear of the true boxes at the support states
  int truly_free = 0;         ///< and between them
  double deepest_m = 0;       ///< how deep a sphere is in a box, at most, in a free row; 0: in none
  double mean_gp_cost = 0;    ///< of all rows
};
std::vector<VerdictCounts> CountVerdicts(const OpenLoopStudy& study);
/// The same for people. What is truly free is so of the rows that are free as published, and the
/// deepest hit is in one of them.
TextTable MakeVerdictTable(const OpenLoopStudy& study);

/// The comparison with a published table, and its rows for the figure.
struct PublishedComparison {
  TableComparison table;
  std::vector<MatchedOutcomes> outcomes;
};

/// Collision-free rate and mean GP cost over the speed, the published points as rings.
/// @param published may be empty.
Figure MakeOpenLoopFigure(const std::vector<MatchedOutcomes>& ours,
                          const std::vector<MatchedOutcomes>& published);

/// The page that tells what came out, from the figures alone.
/// @param svg_path the drawn figure; empty: there is none.
std::string MakeOpenLoopPage(const OpenLoopExperiment& experiment,
                             const OpenLoopStudyOptions& options, const OpenLoopStudy& study,
                             const std::optional<PublishedComparison>& published,
                             const std::vector<OpenLoopStatistics>& statistics,
                             const std::string& svg_path);

}  // namespace sidestep::bench
