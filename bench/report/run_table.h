#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"

namespace sidestep::bench {

/// The runs of a database by columns, as a report needs them: a run is a place in each of them.
struct RunTable {
  /// What was varied; the first is the scenario, if there are several.
  std::vector<FactorColumn> factors;
  std::vector<std::vector<int>> levels;  ///< by factor, by run: a place in its `values`
  std::vector<std::int64_t> id, seed;
  std::vector<int> outcome;           ///< a place in `outcomes`
  std::vector<std::string> outcomes;  ///< words, in their order of first occurrence
  std::map<std::string, std::vector<double>> numbers;  ///< by column; NaN where there is none

  std::size_t size() const { return id.size(); }
  bool Is(std::size_t run, const std::string& outcome_word) const {
    return outcomes[static_cast<std::size_t>(outcome[run])] == outcome_word;
  }
  /// The place of that name or column in `factors`, or -1.
  int FindFactor(const std::string& name) const;
  /// The place of a value among a factor's, or -1.
  int FindLevel(int factor, const std::string& value) const;
};

/// Reads all runs, with these columns of the view `results` and of the table `wall_clock`; those
/// that there are not are left out.
RunTable ReadRunTable(const RunDatabase& database, const std::vector<std::string>& columns);

}  // namespace sidestep::bench
