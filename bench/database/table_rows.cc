#include "sidestep/bench/database/table_rows.h"

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/parse_number.h"

namespace sidestep::bench {
namespace {

bool HasSeveral(const RunDatabase& database, const std::string& column) {
  SqlStatement count = database.sql().Prepare("SELECT count(DISTINCT " + column + ") FROM results");
  return count.Step() && count.Integer(0) > 1;
}

}  // namespace

std::string ValueAsSwept(const FactorColumn& factor, const SqlStatement& row, int column) {
  if (!factor.is_number) return row.Text(column);
  const double number = row.Number(column);
  for (const std::string& value : factor.values) {
    if (NumberIn<double>(value) == number) return value;
  }
  return ShortestText(number);
}

std::vector<RunRow> TableRows(const RunDatabase& database) {
  const bool has_scenarios = HasSeveral(database, "scenario"),
             has_seeds = HasSeveral(database, "seed");
  std::string columns = "scenario, seed, outcome";
  for (const FactorColumn& factor : database.factors()) columns += ", " + SqlName(factor.column);
  for (const Metric& metric : Metrics()) columns += ", " + SqlName(metric.name);
  std::vector<RunRow> rows;
  SqlStatement found = database.Select(columns);
  while (found.Step()) {
    RunRow& row = rows.emplace_back();
    if (has_scenarios) row.factors["scenario"] = found.Text(0);
    if (has_seeds) row.factors["seed"] = found.Text(1);
    row.outcome = found.Text(2);
    int column = 3;
    for (const FactorColumn& factor : database.factors()) {
      row.factors[factor.name] = ValueAsSwept(factor, found, column++);
    }
    for (const Metric& metric : Metrics()) row.metrics[metric.name] = found.Number(column++);
  }
  return rows;
}

}  // namespace sidestep::bench
