#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/run_identity.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// What tells the runs of a sweep apart, e.g. behaviour: stop, seed: 3.
using Factors = std::map<std::string, std::string>;

/// The outcome, beside those of episodes, of what could not be run to its end.
inline constexpr const char* kFailed = "failed";

/// What a run took of real time: all of a row that may differ between equal runs. Not a number
/// where it is unknown.
struct RunClock {
  double episode_s = std::numeric_limits<double>::quiet_NaN();
  double cycle_p50_ms = std::numeric_limits<double>::quiet_NaN();  ///< CPU time, planning cycles
  double cycle_p95_ms = std::numeric_limits<double>::quiet_NaN();
  double cycle_p99_ms = std::numeric_limits<double>::quiet_NaN();
  double cycle_max_ms = std::numeric_limits<double>::quiet_NaN();
  int cycles_over_charge = 0;  ///< EpisodeResult
  int late_plans = 0;
};

/// What of a resolved scenario tables are told by, varied or not. Empty where it was refused.
struct RunSubject {
  std::string robot, planner, knowledge, predictor;
  /// What a planning cycle is charged; not a number where that is measured.
  double charged_latency_s = std::numeric_limits<double>::quiet_NaN();
};
RunSubject SubjectOf(const scenarios::Scenario& scenario);

/// One run: what was varied, and what came of it. Whatever tells results writes and reads this.
struct RunRow {
  Factors factors;                        ///< the same names in all rows of a table
  std::map<std::string, double> drawn;    ///< what its seed decided (Scenario::drawn)
  std::string outcome;                    ///< a word of Outcome, or kFailed
  std::string error;                      ///< why, if it failed; EpisodeResult::reason
  std::string touched;                    ///< what the robot touched first; empty: nothing
  std::map<std::string, double> metrics;  ///< empty if it failed
  RunIdentity identity;                   ///< empty if its scenario was refused
  RunSubject subject;
  RunClock clock;
  std::string trace;    ///< of the run, from the folder of its table; empty if it is not kept
  std::string command;  ///< runs it again, if `sidestep run` can
};

/// What an episode came to; its factors, identity, trace and command are nobody's to know but who
/// ran it.
RunRow RowOf(const EpisodeResult& result, const scenarios::Scenario& scenario);

/// The row of something that could not be done, and why.
RunRow FailedRow(const Factors& factors, const std::string& why);

struct RecordedRun {
  RunRow row;
  std::optional<record::Recording> recording;  ///< none if the episode could not begin
};

/// Runs an episode. One that cannot begin, or in which a number is not finite, is a row too: it
/// failed. One that was aborted has the metrics of what there is.
RecordedRun RunEpisodeRow(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                          const WorldFactory& make_world, const Factors& factors);

/// Looks for a free motion (bench/free_path_search.h) instead; its outcome is that of an episode:
/// goal, or collision if none was found. Its one metric is min_clearance_m.
RunRow RunSearchRow(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                    int max_guesses, const Factors& factors);

}  // namespace sidestep::bench
