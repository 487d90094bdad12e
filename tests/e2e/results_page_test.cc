// docs/results.md and docs/database.md tell every key that runs and sweeps write.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/metrics/registry.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::results_page_test {
namespace {

using Json = nlohmann::json;

struct Row {
  std::string type, unit, meaning;
};
using Rows = std::map<std::string, Row>;

// The rows of one section's table, by their keys.
Rows RowsOf(const std::string& section) {
  std::ifstream page(SIDESTEP_SOURCE_DIR "/docs/results.md");
  Rows rows;
  bool is_here = false;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("## ")) is_here = line == "## " + section;
    if (!is_here || !line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    std::istringstream stream(line.substr(2));
    for (std::string cell; std::getline(stream, cell, '|');) {
      cells.push_back(cell.substr(0, cell.find_last_not_of(' ') + 1));
      cells.back().erase(0, cells.back().find_first_not_of(' '));
    }
    EXPECT_EQ(cells.size(), 4u) << line;
    const std::string key = cells[0].substr(1, cells[0].size() - 2);
    EXPECT_TRUE(rows.emplace(key, Row{cells[1], cells[2], cells[3]}).second) << key << " twice";
  }
  EXPECT_FALSE(rows.empty()) << section;
  return rows;
}

std::set<std::string> KeysOf(const Rows& rows) {
  std::set<std::string> keys;
  for (const auto& [key, row] : rows) keys.insert(key);
  return keys;
}

// Leaves by their paths, but for maps whose keys are explained elsewhere; any stage is <stage>.
void Flatten(const Json& value, const std::string& path, std::map<std::string, Json>& leaves) {
  const bool is_leaf = path == "parameters" || path == "choices" || path == "drawn" ||
                       path == "scans_left_out" || path == "track_events";
  if (!value.is_object() || is_leaf) {
    leaves[path] = value;
    return;
  }
  for (const auto& [key, child] : value.items()) {
    const std::string name = path == "wall_clock.cycle_cpu" ? "<stage>" : key;
    Flatten(child, path.empty() ? name : path + "." + name, leaves);
  }
}

bool IsOfType(const Json& value, const std::string& type) {
  if (value.is_null()) return type.ends_with(" or null");
  if (type.starts_with("text")) return value.is_string();
  if (type.starts_with("whole number")) return value.is_number_integer();
  if (type.starts_with("number")) return value.is_number();
  if (type == "list") return value.is_array();
  return type == "map" && value.is_object();
}

Finished Sidestep(std::vector<std::string> arguments, const std::string& out) {
  arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
  for (const char* const word :
       {"--set", "planner.name=straight_line", "--set", "horizon.duration_s=1", "--out"}) {
    arguments.emplace_back(word);
  }
  arguments.push_back(out);
  return RunProgram(arguments);
}

TEST(ResultsPage, TellsEveryMetricAsItIsRegistered) {
  const Rows rows = RowsOf("Metrics");
  EXPECT_EQ(rows.size(), bench::Metrics().size());
  for (const bench::Metric& metric : bench::Metrics()) {
    ASSERT_EQ(rows.count(metric.name), 1u) << metric.name;
    const Row& row = rows.at(metric.name);
    const std::string unit = metric.unit;
    const bool has_unit = unit != "1" && unit != "count";
    EXPECT_EQ(row.unit, has_unit ? unit : "–") << metric.name;
    EXPECT_EQ(row.type, unit == "count" ? "whole number" : "number or null") << metric.name;
    EXPECT_EQ(row.meaning, metric.meaning) << metric.name;
  }
}

TEST(ResultsPage, TellsEveryKeyOfAResult) {
  Rows rows = RowsOf("`result.json`");
  rows.merge(RowsOf("Metrics"));
  const TemporaryFolder folder;
  for (const char* const scenario : {"hsr_walkway", "walkway_behaviours"}) {
    const Finished finished = Sidestep({"run", scenario, "--json"}, folder.path());
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    std::map<std::string, Json> leaves;
    Flatten(Json::parse(finished.out), "", leaves);
    std::set<std::string> keys;
    for (const auto& [key, value] : leaves) {
      keys.insert(key);
      const auto row = rows.find(key);
      if (row == rows.end()) continue;
      EXPECT_TRUE(IsOfType(value, row->second.type)) << key << ": " << value;
    }
    EXPECT_EQ(keys, KeysOf(rows));
  }
}

// What is in backquotes in the first cells of the tables of docs/database.md.
std::set<std::string> NamesOnTheDatabasePage() {
  std::ifstream page(SIDESTEP_SOURCE_DIR "/docs/database.md");
  std::set<std::string> names;
  for (std::string line; std::getline(page, line);) {
    if (!line.starts_with("| `")) continue;
    const std::string cell = line.substr(2, line.find(" | ", 2) - 2);
    for (std::size_t at = 0; (at = cell.find('`', at)) != std::string::npos;) {
      const std::size_t end = cell.find('`', at + 1);
      names.insert(cell.substr(at + 1, end - at - 1));
      at = end + 1;
    }
  }
  return names;
}

TEST(DatabasePage, TellsEveryColumnAndTable) {
  const TemporaryFolder folder;
  const Finished finished =
      Sidestep({"study", "walkway_behaviours", "--set", "behaviour=stop", "--knowledge", "static",
                "--predictor", "imm", "--speed", "1", "--episodes", "1"},
               folder.path());
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const bench::RunDatabase database(folder.path() / "results.db");
  std::set<std::string> explained;
  for (const bench::FactorColumn& factor : database.factors()) explained.insert(factor.column);
  for (const bench::Metric& metric : bench::Metrics()) explained.insert(metric.name);
  const std::set<std::string> names = NamesOnTheDatabasePage();
  for (const std::string& column : database.columns()) {
    const std::string name = column.starts_with("drawn_") ? "drawn_..." : column;
    EXPECT_TRUE(names.contains(name) || explained.contains(name)) << name;
  }
  bench::SqlStatement tables = database.sql().Prepare(
      "SELECT name FROM sqlite_master WHERE type = 'table' AND name NOT LIKE 'sqlite_%'");
  while (tables.Step()) {
    const std::string table = tables.Text(0) + "(";
    EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return name.starts_with(table);
    })) << table;
  }
}

}  // namespace
}  // namespace sidestep::results_page_test
