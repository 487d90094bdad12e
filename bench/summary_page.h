#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// The factors that a table lists down and across.
struct TableAxes {
  std::string down, across;  ///< empty: none
};

/// Text as it is to be read, in a cell of a table too: names may hold anything.
std::string TableCell(const std::string& text);

/// The values of a factor, in the order in which they come; one word for a factor without a name.
std::vector<std::string> FactorValues(const std::vector<RunRow>& rows, const std::string& factor);

/// A Markdown table: how many episodes reached the goal touching nothing, of how many, for each
/// value of one factor (down) and another (across), in the order in which they come; below it how
/// the others ended. Without `down` only the sums; without `across` one column. Above the values
/// that it lists down stand the names of both factors: "behaviour, by predictor".
std::string OutcomeTable(const std::vector<RunRow>& rows, const TableAxes& axes);

/// What a sweep is of.
struct SweepSubject {
  std::string title;
  std::string description;
  std::string command;  ///< what makes it, quoted for a shell
};

/// A page in Markdown: of what the sweep is, what is varied, its table, and where something varies
/// across, what that does to the same episodes (bench/paired_table.h).
/// @param rows one or more.
std::string SummaryPage(const SweepSubject& subject, const std::vector<RunRow>& rows,
                        const TableAxes& axes);

}  // namespace sidestep::bench
