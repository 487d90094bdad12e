#include "sidestep/bench/database/run_files.h"

#include <algorithm>
#include <set>
#include <utility>

#include "sidestep/bench/database/run_csv.h"
#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/database/run_database_writer.h"
#include "sidestep/bench/summary_page.h"

namespace sidestep::bench {
namespace {

std::vector<FactorColumn> FactorsOfRuns(const std::vector<SingleRun>& runs) {
  std::vector<RunRow> rows;
  for (const SingleRun& run : runs) rows.push_back(run.row);
  std::vector<std::pair<std::string, std::vector<std::string>>> factors;
  for (const auto& [factor, value] : rows.front().factors) {
    factors.emplace_back(factor, FactorValues(rows, factor));
  }
  return FactorColumnsOf(factors);
}

std::vector<std::string> DrawnIn(const std::vector<SingleRun>& runs) {
  std::set<std::string> keys;
  for (const SingleRun& run : runs) {
    for (const auto& [key, value] : run.row.drawn) keys.insert(key);
  }
  return {keys.begin(), keys.end()};
}

}  // namespace

void WriteRunFiles(const std::string& folder, const RunFilesHead& head,
                   const std::vector<SingleRun>& runs) {
  RunTableHead table;
  table.facts = head.facts;
  table.facts["num_planned"] = table.facts["num_done"] = std::to_string(runs.size());
  table.version = head.version;
  if (!runs.empty()) table.factors = FactorsOfRuns(runs);
  table.drawn = DrawnIn(runs);
  for (const SingleRun& run : runs) {
    const auto& known = table.machines;
    if (std::find(known.begin(), known.end(), run.machine) == known.end()) {
      table.machines.push_back(run.machine);
    }
  }
  const std::string path = folder + "/results.db";
  RunDatabaseWriter writer(path, table);
  std::int64_t id = 0;
  for (const SingleRun& run : runs) {
    const auto machine = std::find(table.machines.begin(), table.machines.end(), run.machine);
    writer.Add({.id = ++id,
                .key = "",
                .scenario = run.scenario,
                .setup = run.setup,
                .seed = run.seed,
                .machine = static_cast<int>(machine - table.machines.begin()),
                .combination_command = run.row.command},
               run.row);
  }
  writer.Commit();
  WriteRunCsv(RunDatabase(path), folder + "/results.csv");
}

}  // namespace sidestep::bench
