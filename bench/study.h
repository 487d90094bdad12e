#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/run_identity.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// What tells the episodes of a study apart, e.g. behaviour: stop, seed: 3.
using Factors = std::map<std::string, std::string>;

/// The outcome, beside those of episodes, of what could not be run to its end.
inline constexpr const char* kFailed = "failed";

/// One episode of a study: what was varied, and what came of it.
struct StudyRow {
  Factors factors;                        ///< the same names in all rows
  std::map<std::string, double> drawn;    ///< what its seed decided (Scenario::drawn)
  std::string outcome;                    ///< a word of Outcome, or kFailed
  std::string error;                      ///< why, if it failed; EpisodeResult::reason
  std::map<std::string, double> metrics;  ///< empty if it failed
  RunIdentity identity;                   ///< empty if its scenario was refused
  std::string trace;    ///< of the episode, from the study's folder; empty if it is not kept
  std::string command;  ///< runs it again, if `sidestep run` can
};

/// The row of something that could not be done, and why.
StudyRow FailedRow(const Factors& factors, const std::string& why);

struct StudyEpisode {
  StudyRow row;
  std::optional<record::Recording> recording;  ///< none if the episode could not begin
};

/// Runs an episode. One that cannot begin, or in which a number is not finite, is a row too: it
/// failed. One that was aborted has the metrics of what there is.
StudyEpisode RunStudyEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                             const WorldFactory& make_world, const Factors& factors);

/// Looks for a free motion (bench/free_path_search.h) instead; its outcome is that of an episode:
/// goal, or collision if none was found. Its one metric is min_clearance_m.
StudyRow RunStudySearch(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        int max_guesses, const Factors& factors);

/// All rows, with a column for each factor, each value that was drawn and each metric.
std::string StudyCsv(const std::vector<StudyRow>& rows);

}  // namespace sidestep::bench
