#include "sidestep/bench/report/report_figures.h"

#include <numeric>

#include "sidestep/bench/outcome.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/parse_number.h"

namespace sidestep::bench {
namespace {

constexpr int kMostCurvePoints = 256;

// A level has the same colour in all figures.
int ColorOf(int level) {
  constexpr int kColors[] = {2, 1, 3, 4, 5, 6, 7, 0};  // of the palette, the clearest first
  return kColors[static_cast<std::size_t>(std::max(0, level)) % std::size(kColors)];
}

const FactorColumn& FactorOf(const RunTable& runs, int factor) {
  return runs.factors[static_cast<std::size_t>(factor)];
}

bool IsAt(const RunTable& runs, std::size_t run, int factor, int level) {
  return factor < 0 || runs.levels[static_cast<std::size_t>(factor)][run] == level;
}

double NumberOf(const std::string& text) { return NumberIn<double>(text).value_or(kNaN); }

// The axis of a factor's levels, and where each stands on it.
std::vector<double> LayOut(const RunTable& runs, int factor, Panel* panel) {
  const FactorColumn& column = FactorOf(runs, factor);
  panel->x_label = column.name;
  std::vector<double> x;
  const bool are_numbers = column.is_number && column.values.size() > 1;
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    x.push_back(are_numbers ? NumberOf(column.values[i]) : static_cast<double>(i));
  }
  if (!are_numbers) panel->x_names = column.values;
  return x;
}

// In the order of their place on the axis.
std::vector<std::size_t> Ascending(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  return order;
}

// A series for each group, whose points `fill(level, group, &series)` adds.
template <class AddPoint>
void AddGroups(const RunTable& runs, int factor, int group_factor, const std::vector<int>& groups,
               const AddPoint& add_point, Panel* panel) {
  const std::vector<double> x = LayOut(runs, factor, panel);
  const bool are_names = !panel->x_names.empty();
  const std::vector<int> all = group_factor < 0 ? std::vector<int>{-1} : groups;
  for (std::size_t g = 0; g < all.size(); ++g) {
    Series& series = panel->series.emplace_back();
    if (group_factor >= 0) {
      series.title = FactorOf(runs, group_factor).values[static_cast<std::size_t>(all[g])];
    }
    series.color = ColorOf(all[g]);
    series.style = are_names ? Series::Style::kBars : Series::Style::kLine;
    // Beside one another, where they would hide each other.
    const double shift =
        are_names ? 0.16 * (static_cast<double>(g) - 0.5 * static_cast<double>(all.size() - 1)) : 0;
    for (const std::size_t level : Ascending(x)) {
      const std::size_t before = series.y.size();
      add_point(static_cast<int>(level), all[g], &series);
      if (series.y.size() > before) series.x.push_back(x[level] + shift);
    }
  }
}

}  // namespace

Share ShareOf(const RunTable& runs, int factor, int level, int other_factor, int other_level) {
  const std::string goal = ToString(Outcome::kGoal);
  Share share;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (!IsAt(runs, run, factor, level) || !IsAt(runs, run, other_factor, other_level)) continue;
    if (runs.Is(run, kFailed)) {
      ++share.failed;
      continue;
    }
    ++share.runs;
    share.goals += runs.Is(run, goal) ? 1 : 0;
  }
  share.interval = share.runs > 0 ? WilsonInterval(share.goals, share.runs) : Interval{kNaN, kNaN};
  return share;
}

Panel RatePanel(const RunTable& runs, int factor, int group_factor,
                const std::vector<int>& groups) {
  Panel panel;
  panel.y_label = "goal reached, nothing touched [%]";
  panel.y_range = {-4, 104};
  const auto add = [&](int level, int group, Series* series) {
    const Share share = ShareOf(runs, factor, level, group_factor, group);
    if (share.runs == 0) return;
    series->y.push_back(100.0 * share.goals / share.runs);
    series->low.push_back(100 * share.interval.low);
    series->high.push_back(100 * share.interval.high);
  };
  AddGroups(runs, factor, group_factor, groups, add, &panel);
  return panel;
}

Panel MetricPanel(const RunTable& runs, const std::string& column, const std::string& label,
                  double scale, int factor, int group_factor, const std::vector<int>& groups) {
  Panel panel;
  panel.y_label = label;
  const auto add = [&](int level, int group, Series* series) {
    const std::vector<double> numbers = SortedNumbers(runs, column, [&](std::size_t run) {
      return IsAt(runs, run, factor, level) && IsAt(runs, run, group_factor, group);
    });
    if (numbers.empty()) return;
    series->y.push_back(scale * Quantile(numbers, 0.5));
    series->low.push_back(scale * Quantile(numbers, 0.25));
    series->high.push_back(scale * Quantile(numbers, 0.75));
  };
  AddGroups(runs, factor, group_factor, groups, add, &panel);
  return panel;
}

Panel DistributionPanel(const RunTable& runs, const std::string& column, const std::string& label,
                        double scale, bool log_x, int group_factor,
                        const std::vector<int>& groups) {
  Panel panel;
  panel.x_label = label;
  panel.y_label = "share of runs [%]";
  panel.y_range = {-2, 102};
  panel.log_x = log_x;
  const std::vector<int> all = group_factor < 0 ? std::vector<int>{-1} : groups;
  for (std::size_t g = 0; g < all.size(); ++g) {
    const std::vector<double> numbers = SortedNumbers(
        runs, column, [&](std::size_t run) { return IsAt(runs, run, group_factor, all[g]); });
    if (numbers.empty()) continue;
    Series& series = panel.series.emplace_back();
    series.style = Series::Style::kPlainLine;
    series.color = ColorOf(all[g]);
    if (group_factor >= 0) {
      series.title = FactorOf(runs, group_factor).values[static_cast<std::size_t>(all[g])];
    }
    // Steps; of very many runs only some.
    const auto n = static_cast<double>(numbers.size());
    const std::size_t stride = numbers.size() / kMostCurvePoints + 1;
    series.x.push_back(scale * numbers.front());
    series.y.push_back(0);
    for (std::size_t i = 0; i < numbers.size(); i += stride) {
      const std::size_t last = std::min(i + stride, numbers.size()) - 1;
      series.x.push_back(scale * numbers[last]);
      series.y.push_back(series.y.back());
      series.x.push_back(scale * numbers[last]);
      series.y.push_back(100 * static_cast<double>(last + 1) / n);
    }
  }
  return panel;
}

bool HasNumbers(const RunTable& runs, const std::string& column) {
  const auto found = runs.numbers.find(column);
  return found != runs.numbers.end() &&
         std::any_of(found->second.begin(), found->second.end(),
                     [](double number) { return std::isfinite(number); });
}

}  // namespace sidestep::bench
