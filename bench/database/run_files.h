#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// A run that no sweep has planned.
struct SingleRun {
  RunRow row;            ///< its command without the seed
  std::string scenario;  ///< as tables name it
  std::string setup;     ///< what its scenario is loaded by; empty: nothing can run it again
  std::uint64_t seed = 1;
  std::map<std::string, std::string> machine;  ///< what it is like
};

/// What single runs are told by, beside their rows.
struct RunFilesHead {
  std::map<std::string, std::string> facts;  ///< of the table `sidestep`: title, description, ...
  std::string version;                       ///< of what made the runs
};

/// Writes results.db and results.csv of some runs into a folder, as a sweep leaves them
/// (docs/database.md). Factors, which are the same names in all rows, come in their names' order,
/// their values in the rows'.
/// @throws InputError if they cannot be written.
void WriteRunFiles(const std::string& folder, const RunFilesHead& head,
                   const std::vector<SingleRun>& runs);

}  // namespace sidestep::bench
