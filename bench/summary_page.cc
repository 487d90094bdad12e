#include "sidestep/bench/summary_page.h"

#include <map>
#include <set>

#include "sidestep/bench/paired_table.h"
#include "sidestep/core/joined.h"

namespace sidestep::bench {
namespace {

constexpr std::size_t kMostListed = 12;  // of a factor that are listed

// A row's value of a factor; without a name, all rows are alike.
std::string FactorValueOf(const RunRow& row, const std::string& factor) {
  return factor.empty() ? "episodes" : row.factors.at(factor);
}

struct Tally {
  int goal = 0, episodes = 0;

  void Count(const RunRow& row) {
    ++episodes;
    goal += row.outcome == ToString(Outcome::kGoal) ? 1 : 0;
  }
  std::string Text() const { return std::to_string(goal) + "/" + std::to_string(episodes); }
};

// `a, b, c`; of many, those at the ends.
std::string Listed(const std::vector<std::string>& values) {
  const std::string count = std::to_string(values.size());
  if (values.size() <= kMostListed) return Joined(values);
  return values[0] + ", " + values[1] + ", ..., " + values.back() + " (" + count + ")";
}

// A line for each factor that varies, and one for those that do not.
std::string FactorLines(const std::vector<RunRow>& rows) {
  std::string varied, fixed;
  for (const auto& entry : rows.front().factors) {
    const std::string& factor = entry.first;
    const std::vector<std::string> values = FactorValues(rows, factor);
    if (values.size() > 1) {
      varied += "- varied: " + TableCell(factor) + " = " + TableCell(Listed(values)) + "\n";
    } else {
      fixed += "- fixed: " + TableCell(factor) + " = " + TableCell(values.front()) + "\n";
    }
  }
  return varied + fixed;
}

// What the table lists down, and what the columns are values of.
std::string AxesText(const TableAxes& axes) {
  if (axes.across.empty()) return axes.down;
  return axes.down + (axes.down.empty() ? "by " : ", by ") + axes.across;
}

std::string PairedText(const std::vector<RunRow>& rows, const TableAxes& axes) {
  const std::string table = PairedTable(rows, axes);
  if (table.empty()) return "";
  return "\nThe same episodes with each value of " + TableCell(axes.across) +
         ", and the difference from the first of them (intervals of 95 %, as in `sidestep "
         "report`): "
         "goals; the "
         "median of the least clearance of all; of time and jerk where the goal was reached. "
         "Differences are medians within pairs.\n\n" +
         table;
}

}  // namespace

std::string TableCell(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    const bool is_control = static_cast<unsigned char>(c) < 32;
    if (c == '|') plain += '\\';
    plain += is_control ? ' ' : c;
  }
  return plain;
}

std::vector<std::string> FactorValues(const std::vector<RunRow>& rows, const std::string& factor) {
  std::vector<std::string> values;
  std::set<std::string> seen;
  for (const RunRow& row : rows) {
    const std::string value = FactorValueOf(row, factor);
    if (seen.insert(value).second) values.push_back(value);
  }
  return values;
}

std::string OutcomeTable(const std::vector<RunRow>& rows, const TableAxes& axes) {
  const auto& [down, across] = axes;
  const std::vector<std::string> columns = FactorValues(rows, across);
  const std::vector<std::string> lines =
      down.empty() ? std::vector<std::string>() : FactorValues(rows, down);
  std::map<std::string, std::map<std::string, Tally>> cells;
  std::map<std::string, Tally> totals;
  std::map<std::string, std::map<std::string, int>> endings;
  for (const RunRow& row : rows) {
    const std::string column = FactorValueOf(row, across);
    cells[FactorValueOf(row, down)][column].Count(row);
    totals[column].Count(row);
    ++endings[row.outcome][column];
  }
  std::string text = "| " + TableCell(AxesText(axes)) + " |";
  for (const std::string& column : columns) text += " " + TableCell(column) + " |";
  text += "\n|---|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += "---|";
  for (const std::string& line : lines) {
    text += "\n| " + TableCell(line) + " |";
    for (const std::string& column : columns) text += " " + cells[line][column].Text() + " |";
  }
  text += "\n| all |";
  for (const std::string& column : columns) text += " " + totals[column].Text() + " |";
  for (auto& [outcome, counts] : endings) {
    if (outcome == ToString(Outcome::kGoal)) continue;
    text += "\n| " + outcome + " |";
    for (const std::string& column : columns) text += " " + std::to_string(counts[column]) + " |";
  }
  return text + "\n";
}

std::string SummaryPage(const SweepSubject& subject, const std::vector<RunRow>& rows,
                        const TableAxes& axes) {
  return "# " + TableCell(subject.title) + "\n\n" + TableCell(subject.description) + "\n\n" +
         FactorLines(rows) + "- " + std::to_string(rows.size()) + " episodes, made by\n\n      " +
         subject.command +
         "\n\nHow many reached the goal and touched nothing, of how many, and how the others "
         "ended:\n\n" +
         OutcomeTable(rows, axes) + PairedText(rows, axes);
}

}  // namespace sidestep::bench
