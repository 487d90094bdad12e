#include "sidestep/bench/study.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <stdexcept>

#include "sidestep/bench/free_path_search.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/core/csv.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

void CheckFinite(const record::Recording& recording) {
  for (const ControlSample& tick : recording.control) {
    if (!tick.q.allFinite() || !tick.v.allFinite() || !tick.q_command.allFinite() ||
        !tick.torque.allFinite()) {
      throw std::runtime_error("a number is not finite at " + ShortestText(tick.t.seconds()) +
                               " s");
    }
  }
}

std::vector<std::string> ValuesOf(const std::vector<StudyRow>& rows, const std::string& factor) {
  std::vector<std::string> values;
  for (const StudyRow& row : rows) {
    const std::string& value = row.factors.at(factor);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

struct Tally {
  int goal = 0, episodes = 0;

  void Count(const StudyRow& row) {
    ++episodes;
    goal += row.outcome == ToString(Outcome::kGoal) ? 1 : 0;
  }
  std::string Text() const { return std::to_string(goal) + "/" + std::to_string(episodes); }
};

// The row that `run` fills; what goes wrong is a row too.
StudyRow MakeRow(const std::map<std::string, std::string>& factors,
                 const std::function<void(StudyRow&)>& run) {
  StudyRow row;
  row.factors = factors;
  try {
    run(row);
  } catch (const std::exception& error) {
    row.outcome = "failed";
    row.error = error.what();
  }
  return row;
}

}  // namespace

StudyRow RunStudyEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                         const WorldFactory& make_world,
                         const std::map<std::string, std::string>& factors) {
  return MakeRow(factors, [&](StudyRow& row) {
    const EpisodeResult result = RunEpisode(scenario, robot, make_world);
    if (result.outcome != Outcome::kAborted) CheckFinite(result.recording);
    row.outcome = ToString(result.outcome);
    row.error = result.reason;
    row.metrics = result.recording.metrics;
  });
}

StudyRow RunStudySearch(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        int max_guesses, const std::map<std::string, std::string>& factors) {
  return MakeRow(factors, [&](StudyRow& row) {
    const FreePath path = SearchFreePath(scenario, robot, max_guesses, scenario.seed);
    row.outcome = ToString(path.found ? Outcome::kGoal : Outcome::kCollision);
    row.metrics["min_clearance_m"] = path.clearance_m;
  });
}

std::string StudyCsv(const std::vector<StudyRow>& rows) {
  if (rows.empty()) return "";
  std::vector<std::string> columns;
  for (const auto& [factor, value] : rows.front().factors) columns.push_back(factor);
  columns.insert(columns.end(), {"outcome", "error"});
  for (const Metric& metric : Metrics()) columns.emplace_back(metric.name);
  CsvWriter csv(columns);
  for (const StudyRow& row : rows) {
    std::vector<std::string> fields;
    for (const auto& [factor, value] : row.factors) fields.push_back(value);
    fields.insert(fields.end(), {row.outcome, row.error});
    for (const Metric& metric : Metrics()) {
      const auto found = row.metrics.find(metric.name);
      fields.push_back(found == row.metrics.end() ? "" : CsvNumber(found->second));
    }
    csv.AddRow(fields);
  }
  return csv.text();
}

std::string OutcomeTable(const std::vector<StudyRow>& rows, const std::string& down,
                         const std::string& across) {
  const std::vector<std::string> lines = ValuesOf(rows, down), columns = ValuesOf(rows, across);
  std::map<std::string, std::map<std::string, Tally>> cells;
  std::map<std::string, Tally> totals;
  std::map<std::string, std::map<std::string, int>> endings;
  for (const StudyRow& row : rows) {
    const std::string& column = row.factors.at(across);
    cells[row.factors.at(down)][column].Count(row);
    totals[column].Count(row);
    ++endings[row.outcome][column];
  }
  std::string text = "| " + down + " |";
  for (const std::string& column : columns) text += " " + column + " |";
  text += "\n|---|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += "---|";
  for (const std::string& line : lines) {
    text += "\n| " + line + " |";
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

}  // namespace sidestep::bench
