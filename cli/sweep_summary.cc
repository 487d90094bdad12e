#include "sidestep/cli/sweep_summary.h"

#include <algorithm>

#include "sidestep/bench/database/table_rows.h"
#include "sidestep/cli/console.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"

namespace sidestep::cli {
namespace {

constexpr std::int64_t kMostRows = 20'000;
constexpr std::int64_t kFailuresShown = 5;

struct Varied {
  std::string name;
  bool varies;
};

std::vector<Varied> FactorsOf(const bench::Sweep& sweep) {
  std::vector<Varied> factors;
  if (sweep.scenarios.size() > 1) factors.push_back({"scenario", true});
  for (const bench::SweepAxis& axis : sweep.axes) {
    factors.push_back({axis.name, axis.values.size() > 1});
  }
  if (sweep.seeds.size() > 1) factors.push_back({"seed", true});
  return factors;
}

// The commands of runs that did not reach the goal.
void TellFailures(const bench::RunDatabase& database) {
  const std::string failed = "outcome <> 'goal' AND command IS NOT NULL";
  bench::SqlStatement commands = database.Select("command", failed, "", kFailuresShown);
  bool is_first = true;
  for (; commands.Step(); is_first = false) {
    if (is_first) Print("run again what did not reach the goal, e.g.\n");
    Print("  {}\n", commands.Text(0));
  }
  bench::SqlStatement count =
      database.sql().Prepare("SELECT count(*) FROM results WHERE " + failed);
  if (count.Step() && count.Integer(0) > kFailuresShown) {
    Print("  ({} in all: the column `command` of the results)\n", count.Integer(0));
  }
}

}  // namespace

bench::TableAxes ChooseAxes(const bench::Sweep& sweep, bench::TableAxes axes) {
  std::vector<std::string> known, varying;
  for (const Varied& factor : FactorsOf(sweep)) {
    known.push_back(factor.name);
    const bool is_taken =
        factor.name == axes.down || factor.name == axes.across || factor.name == "seed";
    if (factor.varies && !is_taken) varying.push_back(factor.name);
  }
  const auto check = [&](const char* flag, const std::string& factor) {
    if (factor.empty() || std::find(known.begin(), known.end(), factor) != known.end()) return;
    throw InputError(flag, "'" + factor + "' is no factor of this study (" +
                               (known.empty() ? "it has none: nothing is given to vary"
                                              : "there are: " + Joined(known)) +
                               ")");
  };
  check("--down", axes.down);
  check("--across", axes.across);
  if (!axes.down.empty() && axes.down == axes.across) {
    throw InputError("--across", "'" + axes.across + "' is listed down already");
  }
  const bool one_goes_down = axes.down.empty() && varying.size() == 1;
  if (axes.across.empty() && !varying.empty() && !one_goes_down) {
    for (const std::string& factor : {sweep.question.factor, std::string("knowledge"),
                                      std::string("predictor"), varying.back()}) {
      if (std::erase(varying, factor) == 0) continue;
      axes.across = factor;
      break;
    }
  }
  if (axes.down.empty() && !varying.empty()) axes.down = varying.front();
  return axes;
}

void TellSummary(const bench::RunDatabase& database, const bench::TableAxes& axes,
                 const std::string& command, const std::string& out) {
  if (database.num_runs() == 0 || database.num_runs() > kMostRows) return;
  const std::vector<bench::RunRow> rows = bench::TableRows(database);
  const auto is_there = [&](const std::string& factor) {
    return rows.front().factors.contains(factor) ? factor : std::string();
  };
  const bench::TableAxes there{is_there(axes.down), is_there(axes.across)};
  WriteFile(out + "/summary.md",
            bench::SummaryPage({database.Fact("title"), database.Fact("description"), command},
                               rows, there));
  Print("{}\n", bench::OutcomeTable(rows, there));
  TellFailures(database);
}

}  // namespace sidestep::cli
