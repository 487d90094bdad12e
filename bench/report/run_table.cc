#include "sidestep/bench/report/run_table.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "sidestep/core/input_error.h"
#include "sidestep/core/parse_number.h"

namespace sidestep::bench {
namespace {

// Finds the place of what the database holds among a factor's values.
class Levels {
 public:
  explicit Levels(FactorColumn* factor) : factor_(*factor) {
    for (std::size_t i = 0; i < factor_.values.size(); ++i) Add(static_cast<int>(i));
  }

  int Find(const SqlStatement& row, int column) {
    if (factor_.is_number) {
      const auto found = by_number_.find(row.Number(column));
      if (found != by_number_.end()) return found->second;
    } else {
      const auto found = by_text_.find(row.Text(column));
      if (found != by_text_.end()) return found->second;
    }
    // The sweep does not name it: a scenario, or a value that is told in another way.
    factor_.values.push_back(row.Text(column));
    const int level = static_cast<int>(factor_.values.size()) - 1;
    Add(level);
    if (factor_.is_number) by_number_[row.Number(column)] = level;
    return level;
  }

 private:
  void Add(int level) {
    const std::string& value = factor_.values[static_cast<std::size_t>(level)];
    by_text_[value] = level;
    if (const auto number = NumberIn<double>(value); number && factor_.is_number) {
      by_number_[*number] = level;
    }
  }

  FactorColumn& factor_;
  std::map<std::string, int> by_text_;
  std::map<double, int> by_number_;
};

std::set<std::string> ColumnsOf(const RunDatabase& database, const std::string& table) {
  std::set<std::string> columns;
  const SqlStatement all = database.sql().Prepare("SELECT * FROM " + table + " LIMIT 0");
  for (int c = 0; c < all.num_columns(); ++c) columns.insert(all.ColumnName(c));
  return columns;
}

}  // namespace

int RunTable::FindFactor(const std::string& name) const {
  const auto found = std::find_if(factors.begin(), factors.end(), [&](const FactorColumn& factor) {
    return factor.name == name || factor.column == name;
  });
  return found == factors.end() ? -1 : static_cast<int>(found - factors.begin());
}

int RunTable::FindLevel(int factor, const std::string& value) const {
  const std::vector<std::string>& values = factors[static_cast<std::size_t>(factor)].values;
  const auto found = std::find(values.begin(), values.end(), value);
  return found == values.end() ? -1 : static_cast<int>(found - values.begin());
}

RunTable ReadRunTable(const RunDatabase& database, const std::vector<std::string>& columns) {
  RunTable table;
  table.factors = database.factors();
  FactorColumn scenario;
  scenario.name = scenario.column = "scenario";
  table.factors.insert(table.factors.begin(), scenario);

  const std::set<std::string> of_results = ColumnsOf(database, "results");
  const std::set<std::string> of_clock = ColumnsOf(database, "wall_clock");
  std::string sql = "SELECT r.id, r.seed, r.outcome";
  for (const FactorColumn& factor : table.factors) sql += ", r." + SqlName(factor.column);
  std::vector<std::string> read;
  for (const std::string& column : columns) {
    if (of_results.contains(column)) {
      sql += ", r." + SqlName(column);
    } else if (of_clock.contains(column)) {
      sql += ", w." + SqlName(column);
    } else {
      continue;
    }
    read.push_back(column);
  }
  SqlStatement row = database.sql().Prepare(
      sql + " FROM results r LEFT JOIN wall_clock w ON w.runid = r.id ORDER BY r.id");

  std::vector<Levels> levels;
  levels.reserve(table.factors.size());
  for (FactorColumn& factor : table.factors) levels.emplace_back(&factor);
  table.levels.resize(table.factors.size());
  std::vector<std::vector<double>*> numbers;
  for (const std::string& column : read) numbers.push_back(&table.numbers[column]);
  std::map<std::string, int> outcomes;
  while (row.Step()) {
    table.id.push_back(row.Integer(0));
    table.seed.push_back(row.Integer(1));
    const auto [outcome, is_new] =
        outcomes.emplace(row.Text(2), static_cast<int>(table.outcomes.size()));
    if (is_new) table.outcomes.push_back(row.Text(2));
    table.outcome.push_back(outcome->second);
    int column = 3;
    for (std::size_t f = 0; f < levels.size(); ++f) {
      table.levels[f].push_back(levels[f].Find(row, column++));
    }
    for (std::vector<double>* const values : numbers) values->push_back(row.Number(column++));
  }
  if (table.factors.front().values.size() < 2) {
    table.factors.erase(table.factors.begin());
    table.levels.erase(table.levels.begin());
  }
  return table;
}

}  // namespace sidestep::bench
