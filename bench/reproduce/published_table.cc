#include "sidestep/bench/reproduce/published_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "sidestep/bench/reproduce/published_columns.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

struct CaseMeasure {
  const char* prefix;
  bool is_count;
  double (*get)(const OpenLoopRow::Case& entry);
};
constexpr CaseMeasure kPublishedMeasures[] = {
    {kCollidingPrefix, true,
     [](const OpenLoopRow::Case& c) { return static_cast<double>(c.result.colliding_states); }},
    {kGpCostPrefix, false, [](const OpenLoopRow::Case& c) { return c.result.gp_cost; }},
    {kObstacleCostPrefix, false, [](const OpenLoopRow::Case& c) { return c.result.obstacle_cost; }},
};
constexpr CaseMeasure kOwnMeasures[] = {
    {"iterations_", true,
     [](const OpenLoopRow::Case& c) { return static_cast<double>(c.result.iterations); }},
    {"true_clearance_moving_m_", false,
     [](const OpenLoopRow::Case& c) { return c.clearance.moving_m; }},
    {"true_clearance_static_m_", false,
     [](const OpenLoopRow::Case& c) { return c.clearance.static_m; }},
    {"true_clearance_states_m_", false,
     [](const OpenLoopRow::Case& c) { return c.clearance.states_m; }},
};

struct Column {
  std::string name;
  sdf::Knowledge knowledge;
  double (*get)(const OpenLoopRow::Case& entry);
};

std::vector<Column> ColumnsWithin(const OpenLoopStudy& study) {
  std::vector<Column> columns;
  const auto add = [&](const CaseMeasure& measure, const PublishedCase& entry) {
    if (study.rows.empty() || !study.rows.front().cases.contains(entry.knowledge)) return;
    columns.push_back({std::string(measure.prefix) + entry.name, entry.knowledge, measure.get});
  };
  for (const bool is_published : {true, false}) {
    for (const CaseMeasure& measure : kPublishedMeasures) {
      for (const PublishedCase& entry : kPublishedCases) {
        if (entry.is_published == is_published) add(measure, entry);
      }
    }
  }
  for (const CaseMeasure& measure : kOwnMeasures) {
    for (const PublishedCase& entry : kPublishedCases) add(measure, entry);
  }
  return columns;
}

const CaseMeasure* PublishedMeasure(const std::string& column) {
  for (const CaseMeasure& measure : kPublishedMeasures) {
    if (column.starts_with(measure.prefix)) return &measure;
  }
  return nullptr;
}

// Speeds are decimal fractions: to a micrometre a second they are the same.
using Key = std::pair<int, long>;
Key MakeKey(double pair, double speed_m_s) {
  return {static_cast<int>(std::lround(pair)), std::lround(speed_m_s * 1e6)};
}

std::map<Key, std::size_t> Index(const CsvTable& table, const std::string& path) {
  const auto pair = table.Find(kPairColumn), speed = table.Find(kSpeedColumn);
  if (!pair || !speed) {
    throw InputError(path, 1, pair ? kSpeedColumn : kPairColumn, "there is no such column");
  }
  std::map<Key, std::size_t> rows;
  for (std::size_t row = 0; row < table.num_rows(); ++row) {
    const auto p = table.At(row, *pair), s = table.At(row, *speed);
    const std::string which = "row " + std::to_string(row + 1);
    if (!p || !s) throw InputError(path, which + " has no pair or no speed");
    if (!rows.emplace(MakeKey(*p, *s), row).second) {
      throw InputError(path, which + " repeats the pair and speed of an earlier one");
    }
  }
  return rows;
}

double RelativeDifference(double ours, double published) {
  if (ours == published) return 0;
  return std::abs(ours - published) / std::max(std::abs(published), 1e-300);
}

}  // namespace

CsvTable MakeOpenLoopTable(const OpenLoopStudy& study) {
  const std::vector<Column> columns = ColumnsWithin(study);
  std::vector<std::string> names = {kPairColumn, kSpeedColumn};
  for (const Column& column : columns) names.push_back(column.name);
  names.push_back("n_ignored_spheres");
  CsvTable table(names);
  for (const OpenLoopRow& row : study.rows) {
    std::vector<std::optional<double>> fields = {row.pair, row.speed_m_s};
    for (const Column& column : columns) {
      const double value = column.get(row.cases.at(column.knowledge));
      fields.push_back(std::isfinite(value) ? std::optional(value) : std::nullopt);
    }
    fields.push_back(static_cast<double>(study.ignored_spheres.size()));
    table.AddRow(std::move(fields));
  }
  return table;
}

int TableComparison::CountsCompared() const {
  int sum = 0;
  for (const ColumnComparison& column : columns) sum += column.is_count ? column.compared : 0;
  return sum;
}

int TableComparison::CountsAgreeing() const {
  int sum = 0;
  for (const ColumnComparison& column : columns) sum += column.is_count ? column.agreeing : 0;
  return sum;
}

TableComparison CompareTables(const CsvTable& ours, const CsvTable& published,
                              const std::string& published_path) {
  const std::map<Key, std::size_t> our_rows = Index(ours, "rows.csv");
  const std::map<Key, std::size_t> their_rows = Index(published, published_path);

  TableComparison comparison;
  for (const auto& [key, row] : our_rows) {
    ++(their_rows.contains(key) ? comparison.rows_compared : comparison.rows_only_ours);
  }
  comparison.rows_only_published = static_cast<int>(their_rows.size()) - comparison.rows_compared;

  for (const std::string& name : ours.columns()) {
    const CaseMeasure* const measure = PublishedMeasure(name);
    const auto our_column = ours.Find(name), their_column = published.Find(name);
    if (measure == nullptr || !their_column) continue;
    ColumnComparison column;
    column.column = name;
    column.is_count = measure->is_count;
    for (const auto& [key, our_row] : our_rows) {
      const auto their_row = their_rows.find(key);
      if (their_row == their_rows.end()) continue;
      const auto a = ours.At(our_row, *our_column);
      const auto b = published.At(their_row->second, *their_column);
      if (!a || !b) continue;
      ++column.compared;
      column.mean_ours += *a;
      column.mean_published += *b;
      const double difference = RelativeDifference(*a, *b);
      column.largest_relative_difference = std::max(column.largest_relative_difference, difference);
      if (difference <= (measure->is_count ? 0 : kCostTolerance)) {
        ++column.agreeing;
      } else {
        comparison.differences.push_back(
            {key.first, static_cast<double>(key.second) * 1e-6, name, *a, *b});
      }
    }
    if (column.compared == 0) continue;
    column.mean_ours /= column.compared;
    column.mean_published /= column.compared;
    comparison.columns.push_back(column);
  }
  std::stable_sort(comparison.differences.begin(), comparison.differences.end(),
                   [](const EntryDifference& a, const EntryDifference& b) {
                     return std::pair(a.pair, a.speed_m_s) < std::pair(b.pair, b.speed_m_s);
                   });
  return comparison;
}

TextTable MakeTextTable(const TableComparison& comparison) {
  TextTable rows = {
      {"column", "agree", "largest relative difference", "our mean", "published mean"}};
  for (const ColumnComparison& column : comparison.columns) {
    rows.push_back({column.column, Of(column.agreeing, column.compared),
                    FiniteText("{:.2g}", column.largest_relative_difference),
                    FiniteText("{:.6g}", column.mean_ours),
                    FiniteText("{:.6g}", column.mean_published)});
  }
  return rows;
}

std::string Describe(const TableComparison& comparison) {
  std::string text = fmt::format("{} rows compared", comparison.rows_compared);
  if (comparison.rows_only_published > 0) {
    text += fmt::format("; {} published rows were not run", comparison.rows_only_published);
  }
  if (comparison.rows_only_ours > 0) {
    text += fmt::format("; {} of our rows are not published", comparison.rows_only_ours);
  }
  text += fmt::format("\ncolliding-state counts: {} of {} agree\n", comparison.CountsAgreeing(),
                      comparison.CountsCompared());
  text += ToText(MakeTextTable(comparison));
  text += fmt::format("(costs agree within {:.0e})\n", kCostTolerance);
  for (const EntryDifference& entry : comparison.differences) {
    text += fmt::format("differs: pair {}, {:g} m/s, {}: {:.15g}, published {:.15g}\n", entry.pair,
                        entry.speed_m_s, entry.column, entry.ours, entry.published);
  }
  return text;
}

}  // namespace sidestep::bench
