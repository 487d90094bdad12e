#include "sidestep/bench/study.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <set>
#include <stdexcept>
#include <utility>

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

// A row's value of a factor; without a name, all rows are alike.
std::string ValueOf(const StudyRow& row, const std::string& factor) {
  return factor.empty() ? "episodes" : row.factors.at(factor);
}

std::vector<std::string> ValuesOf(const std::vector<StudyRow>& rows, const std::string& factor) {
  std::vector<std::string> values;
  for (const StudyRow& row : rows) {
    const std::string value = ValueOf(row, factor);
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
StudyRow MakeRow(const scenarios::Scenario& scenario, const Factors& factors,
                 const std::function<void(StudyRow&)>& run) {
  StudyRow row;
  try {
    row.factors = factors;
    run(row);
  } catch (const std::exception& error) {
    row = FailedRow(factors, error.what());
  }
  row.drawn = scenario.drawn;
  return row;
}

std::string NumberField(const std::map<std::string, double>& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? "" : CsvNumber(found->second);
}

}  // namespace

StudyRow FailedRow(const Factors& factors, const std::string& why) {
  StudyRow row;
  row.factors = factors;
  row.outcome = "failed";
  row.error = why;
  return row;
}

StudyEpisode RunStudyEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                             const WorldFactory& make_world, const Factors& factors) {
  std::optional<record::Recording> recording;
  StudyRow made = MakeRow(scenario, factors, [&](StudyRow& row) {
    EpisodeResult result = RunEpisode(scenario, robot, make_world);
    recording = std::move(result.recording);
    if (result.outcome != Outcome::kAborted) CheckFinite(*recording);
    row.error = result.reason;
    row.outcome = ToString(result.outcome);
    row.metrics = recording->metrics;
  });
  return {std::move(made), std::move(recording)};
}

StudyRow RunStudySearch(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        int max_guesses, const Factors& factors) {
  return MakeRow(scenario, factors, [&](StudyRow& row) {
    const FreePath path = SearchFreePath(scenario, robot, max_guesses, scenario.seed);
    row.outcome = ToString(path.found ? Outcome::kGoal : Outcome::kCollision);
    row.metrics["min_clearance_m"] = path.clearance_m;
  });
}

std::string StudyCsv(const std::vector<StudyRow>& rows) {
  if (rows.empty()) return "";
  std::set<std::string> drawn;
  for (const StudyRow& row : rows) {
    for (const auto& [key, value] : row.drawn) drawn.insert(key);
  }
  std::vector<std::string> columns;
  for (const auto& [factor, value] : rows.front().factors) columns.push_back(factor);
  for (const std::string& key : drawn) columns.push_back("drawn." + key);
  columns.insert(columns.end(), {"outcome", "error"});
  for (const Metric& metric : Metrics()) columns.emplace_back(metric.name);
  columns.insert(columns.end(), {"run", "trace", "command"});
  CsvWriter csv(columns);
  for (const StudyRow& row : rows) {
    std::vector<std::string> fields;
    for (const auto& [factor, value] : row.factors) fields.push_back(value);
    for (const std::string& key : drawn) fields.push_back(NumberField(row.drawn, key));
    fields.insert(fields.end(), {row.outcome, row.error});
    for (const Metric& metric : Metrics()) fields.push_back(NumberField(row.metrics, metric.name));
    const bool was_run = !row.identity.build.empty();
    fields.insert(fields.end(), {was_run ? RunId(row.identity) : "", row.trace, row.command});
    csv.AddRow(fields);
  }
  return csv.text();
}

std::string OutcomeTable(const std::vector<StudyRow>& rows, const std::string& down,
                         const std::string& across) {
  const std::vector<std::string> columns = ValuesOf(rows, across);
  const std::vector<std::string> lines =
      down.empty() ? std::vector<std::string>() : ValuesOf(rows, down);
  std::map<std::string, std::map<std::string, Tally>> cells;
  std::map<std::string, Tally> totals;
  std::map<std::string, std::map<std::string, int>> endings;
  for (const StudyRow& row : rows) {
    const std::string column = ValueOf(row, across);
    cells[ValueOf(row, down)][column].Count(row);
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
