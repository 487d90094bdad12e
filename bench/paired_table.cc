#include "sidestep/bench/paired_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sidestep/bench/outcome.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/bench/statistics/paired_medians.h"
#include "sidestep/bench/statistics/paired_rates.h"

namespace sidestep::bench {
namespace {

constexpr const char* kEmptyCell = "–";

bool ReachedGoal(const RunRow& row) { return row.outcome == ToString(Outcome::kGoal); }

double MetricOf(const RunRow& row, const char* name) {
  const auto found = row.metrics.find(name);
  return found == row.metrics.end() ? kNaN : found->second;
}

// What rows are compared by, beside whether they reached the goal.
struct ComparedMeasure {
  const char* title;
  int digits;
  double (*of)(const RunRow&);
};

const ComparedMeasure kComparedMeasures[] = {
    {"clearance [mm]", 1, [](const RunRow& row) { return 1e3 * MetricOf(row, "min_clearance_m"); }},
    {"time [s]", 3,
     [](const RunRow& row) { return ReachedGoal(row) ? MetricOf(row, "time_to_goal_s") : kNaN; }},
    {"jerk [rad/s³]", 1,
     [](const RunRow& row) { return ReachedGoal(row) ? MetricOf(row, "jerk_rms") : kNaN; }},
};

// One episode under two treatments: what is looked at, and what it is set beside.
struct RowPair {
  const RunRow* row;
  const RunRow* beside;
  int cluster;  // pairs of one seed resemble each other
};

std::vector<double> Values(const std::vector<RowPair>& pairs, const ComparedMeasure& measure) {
  std::vector<double> values;
  for (const RowPair& pair : pairs) {
    const double value = measure.of(*pair.row);
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

// `+2.5 (-1.0 to 5.0)`
std::string WithInterval(double difference, const Interval& interval, int digits) {
  std::string text = fmt::format("{:+.{}f}", difference, digits);
  if (std::isfinite(interval.low)) {
    text += fmt::format(" ({:.{}f} to {:.{}f})", interval.low, digits, interval.high, digits);
  }
  return text;
}

std::string RateDifferenceText(const std::vector<RowPair>& pairs) {
  if (pairs.empty()) return kEmptyCell;
  std::vector<PairedOutcome> outcomes;
  for (const RowPair& pair : pairs) {
    outcomes.push_back({pair.cluster, ReachedGoal(*pair.row), ReachedGoal(*pair.beside)});
  }
  const PairedRates rates = ComparePairedRates(outcomes);
  return WithInterval(100 * rates.difference, {100 * rates.interval.low, 100 * rates.interval.high},
                      1);
}

std::string DifferenceText(const std::vector<RowPair>& pairs, const ComparedMeasure& measure) {
  std::vector<PairedNumber> numbers;
  for (const RowPair& pair : pairs) {
    const double value = measure.of(*pair.row), beside = measure.of(*pair.beside);
    if (std::isfinite(value) && std::isfinite(beside)) {
      numbers.push_back({pair.cluster, value, beside});
    }
  }
  if (numbers.empty()) return kEmptyCell;
  const PairedMedians medians = ComparePairedMedians(numbers);
  return WithInterval(medians.difference, medians.interval, measure.digits);
}

std::string TableRowText(const std::string& down, const std::string& across,
                         const std::vector<RowPair>& pairs, bool is_first) {
  const auto goals = std::count_if(pairs.begin(), pairs.end(),
                                   [](const RowPair& pair) { return ReachedGoal(*pair.row); });
  std::string text = fmt::format("| {} | {} | {} |", down, across, pairs.size());
  text += pairs.empty() ? fmt::format(" {} |", kEmptyCell)
                        : fmt::format(" {:.1f} |", 100.0 * static_cast<double>(goals) /
                                                       static_cast<double>(pairs.size()));
  text += fmt::format(" {} |", is_first ? kEmptyCell : RateDifferenceText(pairs));
  for (const ComparedMeasure& measure : kComparedMeasures) {
    const double median = Quantile(Values(pairs, measure), 0.5);
    text += std::isfinite(median) ? fmt::format(" {:.{}f} |", median, measure.digits)
                                  : fmt::format(" {} |", kEmptyCell);
    text += fmt::format(" {} |", is_first ? kEmptyCell : DifferenceText(pairs, measure));
  }
  return text + "\n";
}

// What episodes agree in that differ by the factor across alone.
Factors FactorsBut(const RunRow& row, const std::string& across) {
  Factors all_else = row.factors;
  all_else.erase(across);
  return all_else;
}

// Episodes by that, and by the value across.
using Treated = std::map<std::string, const RunRow*>;

std::map<Factors, Treated> ByAllElse(const std::vector<RunRow>& rows, const std::string& across) {
  std::map<Factors, Treated> episodes;
  for (const RunRow& row : rows) {
    if (row.outcome != kFailed) episodes[FactorsBut(row, across)][row.factors.at(across)] = &row;
  }
  return episodes;
}

// The pairs of two values across, in the rows' order; `is_asked` chooses by all other factors.
template <class IsAsked>
std::vector<RowPair> RowPairsOf(const std::vector<RunRow>& rows,
                                const std::map<Factors, Treated>& episodes,
                                const std::string& across, const std::string& value,
                                const std::string& beside, const IsAsked& is_asked) {
  std::vector<RowPair> pairs;
  std::map<std::string, int> seeds;
  for (const RunRow& row : rows) {
    if (row.outcome == kFailed || row.factors.at(across) != value) continue;
    const Factors all_else = FactorsBut(row, across);
    const Treated& treated = episodes.at(all_else);
    const auto other = treated.find(beside);
    if (!is_asked(all_else) || other == treated.end()) continue;
    const auto seed = all_else.find("seed");
    // Without seeds, every episode is its own.
    const int cluster =
        seed == all_else.end()
            ? static_cast<int>(pairs.size())
            : seeds.emplace(seed->second, static_cast<int>(seeds.size())).first->second;
    pairs.push_back({&row, other->second, cluster});
  }
  return pairs;
}

std::string HeadText(const TableAxes& axes) {
  std::string text = "| " + TableCell(axes.down) + " | " + TableCell(axes.across) +
                     " | pairs | goal [%] | difference |";
  std::string rule = "|---|---|---|---|---|";
  for (const ComparedMeasure& measure : kComparedMeasures) {
    text += fmt::format(" {} | difference |", measure.title);
    rule += "---|---|";
  }
  return text + "\n" + rule + "\n";
}

}  // namespace

std::string PairedTable(const std::vector<RunRow>& rows, const TableAxes& axes) {
  const std::string &down = axes.down, &across = axes.across;
  const std::vector<std::string> columns = FactorValues(rows, across);
  if (columns.size() < 2) return "";
  const std::map<Factors, Treated> episodes = ByAllElse(rows, across);
  std::string text = HeadText(axes);
  const auto add_rows = [&](const std::string& title, const auto& is_asked) {
    for (const std::string& column : columns) {
      text += TableRowText(title, TableCell(column),
                           RowPairsOf(rows, episodes, across, column, columns.front(), is_asked),
                           column == columns.front());
    }
  };
  if (!down.empty()) {
    for (const std::string& line : FactorValues(rows, down)) {
      add_rows(TableCell(line), [&](const Factors& factors) { return factors.at(down) == line; });
    }
  }
  add_rows("all", [](const Factors&) { return true; });
  return text;
}

}  // namespace sidestep::bench
