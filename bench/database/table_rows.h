#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// Every run of a database as tables are made from it (bench/summary_page.h, bench/paired_table.h):
/// its factors (`scenario` and `seed` where there are several, and every axis), outcome and
/// metrics. For so many rows as a table is for.
std::vector<RunRow> TableRows(const RunDatabase& database);

/// The value of a factor as the sweep has it, where its column may hold it as a number.
std::string ValueAsSwept(const FactorColumn& factor, const SqlStatement& row, int column);

}  // namespace sidestep::bench
