#include "sidestep/bench/run_row.h"

#include <cmath>
#include <exception>
#include <functional>
#include <set>
#include <stdexcept>
#include <utility>

#include "sidestep/bench/free_path_search.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/result_file.h"
#include "sidestep/bench/statistics.h"
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

RunClock ClockOf(const EpisodeResult& result) {
  RunClock clock;
  clock.episode_s = result.wall_s;
  const auto cycles = result.times.find("cycle");
  if (cycles != result.times.end()) {
    clock.cycle_p50_ms = 1e3 * Quantile(cycles->second, 0.5);
    clock.cycle_p95_ms = 1e3 * Quantile(cycles->second, 0.95);
    clock.cycle_p99_ms = 1e3 * Quantile(cycles->second, 0.99);
    clock.cycle_max_ms = 1e3 * Quantile(cycles->second, 1);
  }
  clock.cycles_over_charge = result.cycles_over_charge;
  clock.late_plans = result.late_plans;
  return clock;
}

// The row that `run` fills; what goes wrong is a row too.
RunRow MakeRow(const scenarios::Scenario& scenario, const Factors& factors,
               const std::function<void(RunRow&)>& run) {
  RunRow row;
  try {
    row.factors = factors;
    run(row);
  } catch (const std::exception& error) {
    row = FailedRow(factors, error.what());
  }
  row.drawn = scenario.drawn;
  row.subject = SubjectOf(scenario);
  return row;
}

std::string NumberField(const std::map<std::string, double>& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? "" : CsvNumber(found->second);
}

}  // namespace

RunSubject SubjectOf(const scenarios::Scenario& scenario) {
  RunSubject subject{scenario.robot, scenario.planner, scenario.knowledge, scenario.predictor};
  if (scenario.latency != scenarios::Latency::kMeasured) {
    subject.charged_latency_s = scenario.longest_latency_s();
  }
  return subject;
}

RunRow FailedRow(const Factors& factors, const std::string& why) {
  RunRow row;
  row.factors = factors;
  row.outcome = kFailed;
  row.error = why;
  return row;
}

RecordedRun RunEpisodeRow(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                          const WorldFactory& make_world, const Factors& factors) {
  std::optional<record::Recording> recording;
  RunRow made = MakeRow(scenario, factors, [&](RunRow& row) {
    EpisodeResult result = RunEpisode(scenario, robot, make_world);
    recording = std::move(result.recording);
    if (result.outcome != Outcome::kAborted) CheckFinite(*recording);
    row.error = result.reason;
    row.outcome = ToString(result.outcome);
    row.touched = TouchedBy(*recording);
    row.metrics = recording->metrics;
    row.clock = ClockOf(result);
  });
  return {std::move(made), std::move(recording)};
}

RunRow RunSearchRow(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                    int max_guesses, const Factors& factors) {
  return MakeRow(scenario, factors, [&](RunRow& row) {
    const FreePath path = SearchFreePath(scenario, robot, max_guesses, scenario.seed);
    row.outcome = ToString(path.found ? Outcome::kGoal : Outcome::kCollision);
    row.metrics["min_clearance_m"] = path.clearance_m;
  });
}

std::string RunsCsv(const std::vector<RunRow>& rows) {
  if (rows.empty()) return "";
  std::set<std::string> drawn;
  for (const RunRow& row : rows) {
    for (const auto& [key, value] : row.drawn) drawn.insert(key);
  }
  std::vector<std::string> columns;
  for (const auto& [factor, value] : rows.front().factors) columns.push_back(factor);
  for (const std::string& key : drawn) columns.push_back("drawn." + key);
  columns.insert(columns.end(), {"outcome", "error"});
  for (const Metric& metric : Metrics()) columns.emplace_back(metric.name);
  columns.insert(columns.end(), {"run", "trace", "command"});
  CsvWriter csv(columns);
  for (const RunRow& row : rows) {
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

}  // namespace sidestep::bench
