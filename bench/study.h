#pragma once

#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// One episode of a study: what was varied, and what came of it.
struct StudyRow {
  std::map<std::string, std::string> factors;  ///< e.g. behaviour: stop; the same names in all rows
  std::string outcome;                         ///< a word of Outcome, or "failed"
  std::string error;                           ///< why, if it failed; EpisodeResult::reason
  std::map<std::string, double> metrics;       ///< empty if it failed
};

/// Runs an episode. One that cannot begin, or in which a number is not finite, is a row too: it
/// failed. One that was aborted has the metrics of what there is.
StudyRow RunStudyEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                         const WorldFactory& make_world,
                         const std::map<std::string, std::string>& factors);

/// Looks for a free motion (bench/free_path_search.h) instead; its outcome is that of an episode:
/// goal, or collision if none was found. Its one metric is min_clearance_m.
StudyRow RunStudySearch(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        int max_guesses, const std::map<std::string, std::string>& factors);

/// All rows, with a column for each factor and each metric.
std::string StudyCsv(const std::vector<StudyRow>& rows);

/// A Markdown table: how many episodes reached the goal touching nothing, of how many, for each
/// value of one factor (down) and another (across), in the order in which they come; below it how
/// the others ended.
std::string OutcomeTable(const std::vector<StudyRow>& rows, const std::string& down,
                         const std::string& across);

}  // namespace sidestep::bench
