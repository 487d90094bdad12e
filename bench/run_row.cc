#include "sidestep/bench/run_row.h"

#include <cmath>
#include <exception>
#include <functional>
#include <stdexcept>
#include <utility>

#include "sidestep/bench/free_path_search.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/result_file.h"
#include "sidestep/bench/statistics.h"
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

}  // namespace

RunSubject SubjectOf(const scenarios::Scenario& scenario) {
  RunSubject subject{scenario.robot, scenario.planner, scenario.knowledge, scenario.predictor};
  if (scenario.latency != scenarios::Latency::kMeasured) {
    subject.charged_latency_s = scenario.longest_latency_s();
  }
  return subject;
}

RunRow RowOf(const EpisodeResult& result, const scenarios::Scenario& scenario) {
  RunRow row;
  row.drawn = scenario.drawn;
  row.outcome = ToString(result.outcome);
  row.error = result.reason;
  row.touched = TouchedBy(result.recording);
  row.metrics = result.recording.metrics;
  row.subject = SubjectOf(scenario);
  row.clock = ClockOf(result);
  return row;
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
    row = RowOf(result, scenario);
    row.factors = factors;
    recording = std::move(result.recording);
    if (result.outcome != Outcome::kAborted) CheckFinite(*recording);
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

}  // namespace sidestep::bench
