#include "sidestep/bench/paired_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "sidestep/bench/outcome.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/bench/statistics/resampling.h"

namespace sidestep::bench {
namespace {

constexpr int kDraws = 2000;
constexpr std::uint64_t kSeed = 1;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kNothing = "–";

bool ReachedGoal(const RunRow& row) { return row.outcome == ToString(Outcome::kGoal); }

double GoalOf(const RunRow& row) { return ReachedGoal(row) ? 100 : 0; }

double MetricOf(const RunRow& row, const char* name) {
  const auto found = row.metrics.find(name);
  return found == row.metrics.end() ? kNone : found->second;
}

// What rows are compared by.
struct Measure {
  const char* title;
  int digits;
  double (*of)(const RunRow&);
  double (*middle)(const std::vector<double>&);
};

double Mean(const std::vector<double>& values) {
  if (values.empty()) return kNone;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double Median(const std::vector<double>& values) { return Quantile(values, 0.5); }

const Measure kMeasures[] = {
    {"goal [%]", 1, &GoalOf, &Mean},
    {"clearance [mm]", 1, [](const RunRow& row) { return 1e3 * MetricOf(row, "min_clearance_m"); },
     &Median},
    {"time [s]", 3,
     [](const RunRow& row) { return ReachedGoal(row) ? MetricOf(row, "time_to_goal_s") : kNone; },
     &Median},
    {"jerk [rad/s³]", 1,
     [](const RunRow& row) { return ReachedGoal(row) ? MetricOf(row, "jerk_rms") : kNone; },
     &Median},
};

// One episode under two treatments: what is looked at, and what it is set beside.
struct Pair {
  const RunRow* row;
  const RunRow* beside;
};
using Clusters = std::vector<std::vector<Pair>>;

std::vector<double> Values(const Clusters& clusters, const Measure& measure) {
  std::vector<double> values;
  for (const std::vector<Pair>& cluster : clusters) {
    for (const Pair& pair : cluster) {
      const double value = measure.of(*pair.row);
      if (std::isfinite(value)) values.push_back(value);
    }
  }
  return values;
}

std::vector<std::vector<double>> Differences(const Clusters& clusters, const Measure& measure) {
  std::vector<std::vector<double>> differences;
  for (const std::vector<Pair>& cluster : clusters) {
    std::vector<double>& of_cluster = differences.emplace_back();
    for (const Pair& pair : cluster) {
      const double difference = measure.of(*pair.row) - measure.of(*pair.beside);
      if (std::isfinite(difference)) of_cluster.push_back(difference);
    }
  }
  return differences;
}

// `+2.5 (-1.0 to 5.0)`
std::string DifferenceText(const Clusters& clusters, const Measure& measure) {
  const std::vector<std::vector<double>> differences = Differences(clusters, measure);
  const auto middle_of = [&](const std::vector<int>& sample) {
    std::vector<double> drawn;
    for (const int c : sample) {
      const std::vector<double>& cluster = differences[static_cast<std::size_t>(c)];
      drawn.insert(drawn.end(), cluster.begin(), cluster.end());
    }
    return measure.middle(drawn);
  };
  std::vector<int> each_once(differences.size());
  std::iota(each_once.begin(), each_once.end(), 0);
  const double middle = middle_of(each_once);
  if (!std::isfinite(middle)) return kNothing;
  std::string text = fmt::format("{:+.{}f}", middle, measure.digits);
  if (differences.size() > 1) {
    const Interval interval =
        BootstrapOverClusters(static_cast<int>(differences.size()), middle_of, kDraws, kSeed);
    text += fmt::format(" ({:.{}f} to {:.{}f})", interval.low, measure.digits, interval.high,
                        measure.digits);
  }
  return text;
}

std::string RowText(const std::string& down, const std::string& across, const Clusters& clusters,
                    bool is_first) {
  std::size_t num_pairs = 0;
  for (const std::vector<Pair>& cluster : clusters) num_pairs += cluster.size();
  std::string text = fmt::format("| {} | {} | {} |", down, across, num_pairs);
  for (const Measure& measure : kMeasures) {
    const double middle = measure.middle(Values(clusters, measure));
    text += std::isfinite(middle) ? fmt::format(" {:.{}f} |", middle, measure.digits)
                                  : fmt::format(" {} |", kNothing);
    text += fmt::format(" {} |", is_first ? kNothing : DifferenceText(clusters, measure));
  }
  return text + "\n";
}

// Episodes that differ by the factor across alone, by its value.
using Treated = std::map<std::string, const RunRow*>;

std::map<Factors, Treated> ByAllElse(const std::vector<RunRow>& rows, const std::string& across) {
  std::map<Factors, Treated> episodes;
  for (const RunRow& row : rows) {
    if (row.outcome == kFailed) continue;
    Factors all_else = row.factors;
    all_else.erase(across);
    episodes[all_else][row.factors.at(across)] = &row;
  }
  return episodes;
}

// The pairs of two values across, by seed; `is_asked` chooses by all other factors.
template <class IsAsked>
Clusters PairsOf(const std::map<Factors, Treated>& episodes, const std::string& value,
                 const std::string& beside, const IsAsked& is_asked) {
  std::map<std::string, std::vector<Pair>> by_seed;
  for (const auto& [factors, treated] : episodes) {
    const auto one = treated.find(value), other = treated.find(beside);
    if (!is_asked(factors) || one == treated.end() || other == treated.end()) continue;
    const auto seed = factors.find("seed");
    // Without seeds, every episode is its own.
    const std::string cluster =
        seed == factors.end() ? std::to_string(by_seed.size()) : seed->second;
    by_seed[cluster].push_back({one->second, other->second});
  }
  Clusters clusters;
  for (auto& [seed, pairs] : by_seed) clusters.push_back(std::move(pairs));
  return clusters;
}

std::string HeadText(const TableAxes& axes) {
  std::string text = "| " + TableCell(axes.down) + " | " + TableCell(axes.across) + " | pairs |";
  std::string rule = "|---|---|---|";
  for (const Measure& measure : kMeasures) {
    text += fmt::format(" {} | difference |", measure.title);
    rule += "---|---|";
  }
  return text + "\n" + rule + "\n";
}

}  // namespace

std::string PairedTable(const std::vector<RunRow>& rows, const TableAxes& axes) {
  const auto& [down, across] = axes;
  const std::vector<std::string> columns = FactorValues(rows, across);
  if (columns.size() < 2) return "";
  const std::map<Factors, Treated> episodes = ByAllElse(rows, across);
  std::string text = HeadText(axes);
  const auto add_rows = [&](const std::string& title, const auto& is_asked) {
    for (const std::string& column : columns) {
      text +=
          RowText(title, TableCell(column), PairsOf(episodes, column, columns.front(), is_asked),
                  column == columns.front());
    }
  };
  if (!down.empty()) {
    for (const std::string& line : FactorValues(rows, down)) {
      add_rows(TableCell(line),
               [&, &key = down](const Factors& factors) { return factors.at(key) == line; });
    }
  }
  add_rows("all", [](const Factors&) { return true; });
  return text;
}

}  // namespace sidestep::bench
