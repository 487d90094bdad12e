#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// What has to be known of a database's rows before the first of them is written.
struct RunTableHead {
  std::map<std::string, std::string> facts;  ///< of the table `sidestep`, beside its format
  std::string version;                       ///< of what made the runs, as Planner Arena lists it
  std::vector<FactorColumn> factors;
  std::vector<std::string> drawn;  ///< the keys of RunRow::drawn that there are
  /// By machine, as rows count them: what they are like. Of the tables of the wall clock.
  std::vector<std::map<std::string, std::string>> machines;
};

/// One run as it stands in a database.
struct NumberedRun {
  std::int64_t id = 0;   ///< from 1, ascending from row to row
  std::string key;       ///< of the sweep's plan; empty: no sweep has planned it
  std::string scenario;  ///< as the sweep names it
  std::string setup;     ///< what it is loaded by; empty: nothing can run it again
  std::uint64_t seed = 0;
  int machine = 0;
  std::string combination_command;  ///< RunRow::command without its seed; empty: none
};

/// The columns of factors, each with its name and its values: valid for SQL, Planner Arena and each
/// other.
std::vector<FactorColumn> FactorColumnsOf(
    const std::vector<std::pair<std::string, std::vector<std::string>>>& factors);

/// The column of what was drawn under a key of RunRow::drawn.
std::string DrawnColumn(const std::string& key);

/// Writes a database, row by row, in memory that does not grow with them. The file appears when it
/// is committed, whole, or not at all.
class RunDatabaseWriter {
 public:
  /// @throws InputError if it cannot be written.
  RunDatabaseWriter(const std::string& path, const RunTableHead& head);
  ~RunDatabaseWriter();
  RunDatabaseWriter(const RunDatabaseWriter&) = delete;
  RunDatabaseWriter& operator=(const RunDatabaseWriter&) = delete;

  void Add(const NumberedRun& run, const RunRow& row);
  /// Call once, last.
  void Commit();

 private:
  class Tables;
  std::string path_, temporary_;
  RunTableHead head_;
  std::unique_ptr<Tables> tables_;
};

}  // namespace sidestep::bench
