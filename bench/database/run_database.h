#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/database/sqlite.h"

namespace sidestep::bench {

/// What the file is of: docs/database.md. Another number, another schema.
inline constexpr const char* kDatabaseFormat = "sidestep-results-1";

/// What was varied, and by which column tables and the view `results` hold it.
struct FactorColumn {
  std::string name;    ///< as the sweep has it: `planner.epsilon_m`, `knowledge`
  std::string column;  ///< as SQL and Planner Arena take it: `planner_epsilon_m`
  /// How the robot plans, and so a part of plannerConfigs; else of the problem, of experiments.
  bool is_planner = false;
  bool is_number = false;                ///< every value of it is one
  std::vector<std::string> values = {};  ///< in the sweep's order, as it has them
};

/// The results of a sweep, to be read. Everything throws InputError.
///
/// One row of the view `results` is one run, with all that is known of it but what it took of real
/// time; docs/database.md has its columns. Ask for rows in SQL:
///
///     auto rows = database.Select("id, min_clearance_m", "outcome = 'collision'", "id", 10);
///     while (rows.Step()) Use(rows.Integer(0), rows.Number(1));
class RunDatabase {
 public:
  /// @throws InputError if there is no such file, or it is none of ours.
  explicit RunDatabase(const std::string& path);

  /// The table `sidestep`: format, title, description, num_planned, num_done, ...
  const std::map<std::string, std::string>& facts() const { return facts_; }
  /// The fact of that name, or nothing.
  std::string Fact(const std::string& name) const;
  const std::vector<FactorColumn>& factors() const { return factors_; }
  /// The columns of the view `results`, in its order.
  const std::vector<std::string>& columns() const { return columns_; }
  std::int64_t num_runs() const;

  /// Rows of the view `results`.
  /// @param what columns, with commas; "*" for all.
  /// @param where, order expressions of SQL over its columns; empty: all, by id.
  /// @param limit at most so many; -1: all.
  /// @throws InputError `PATH: WHY` for what is no SQL, or no column.
  SqlStatement Select(const std::string& what, const std::string& where = "",
                      const std::string& order = "", std::int64_t limit = -1) const;

  const SqlDatabase& sql() const { return database_; }

 private:
  SqlDatabase database_;
  std::map<std::string, std::string> facts_;
  std::vector<FactorColumn> factors_;
  std::vector<std::string> columns_;
};

/// One word for everything in the file but what depends on the machine and its clock (the tables
/// `wall_clock...`): equal for equal results, wherever and by whomever they were made.
std::string DigestOf(const RunDatabase& database);

}  // namespace sidestep::bench
