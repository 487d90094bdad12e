#pragma once

#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/csv_table.h"
#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {

/// What one run came to.
struct OpenLoopOutcome {
  bool is_free = false;  ///< by the published verdict
  double gp_cost = 0;    ///< NaN where the solver ran away
};

/// The same start, goal and speed under several kinds of knowledge: what makes runs comparable.
struct MatchedOutcomes {
  int pair = 0;
  double speed_m_s = 0;
  std::map<sdf::Knowledge, OpenLoopOutcome> runs;
};

/// The outcomes of a table with the published column names: ours, or a published one. A kind of
/// knowledge is in `runs` if the row says how many of its states collide.
/// @throws std::invalid_argument without columns for pair and speed, or with an empty field there.
std::vector<MatchedOutcomes> ReadOutcomes(const CsvTable& table);

/// Which rows count.
enum class RowFilter {
  kAllRows,
  /// As in the publication: without the experiment's excluded speeds, and without rows in which
  /// none of the published kinds of knowledge is collision-free.
  kPublishedExclusions,
};
/// "all_rows", "published_exclusions".
std::string ToString(RowFilter filter);

/// Whether the rows hold what the filter asks for: for the publication's, all of the published
/// kinds of knowledge.
bool CanFilter(const std::vector<MatchedOutcomes>& rows, RowFilter filter);

/// What a filter left, and what it left out.
struct FilteredRows {
  std::vector<MatchedOutcomes> rows;
  int excluded_by_speed = 0;   ///< of the rows given
  int excluded_none_free = 0;  ///< of those left after that
};
FilteredRows Filter(const std::vector<MatchedOutcomes>& rows, RowFilter filter,
                    const OpenLoopExperiment& experiment);

}  // namespace sidestep::bench
