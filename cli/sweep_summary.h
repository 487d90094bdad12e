#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/summary_page.h"
#include "sidestep/bench/sweep/sweep.h"

namespace sidestep::cli {

/// Fills what is empty, from what varies beside seeds: what the sweep compares, the kinds of
/// knowledge or else the predictors go across, and what comes first of the others down.
/// @throws InputError `--down: WHY`, `--across: WHY` for a name that is no factor, or asked for
/// twice.
bench::TableAxes ChooseAxes(const bench::Sweep& sweep, bench::TableAxes asked);

/// Prints the table of outcomes, writes it into `out`/summary.md, and says what runs again what did
/// not reach the goal. Does nothing of a database that has more rows than tables are for.
/// @param command that makes the sweep.
void TellSummary(const bench::RunDatabase& database, const bench::TableAxes& axes,
                 const std::string& command, const std::string& out);

}  // namespace sidestep::cli
