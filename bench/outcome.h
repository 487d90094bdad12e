#pragma once

#include <map>
#include <optional>
#include <string>

#include "sidestep/record/recording.h"

namespace sidestep::bench {

/// How an episode ended: of what is true of it, what stands first here.
enum class Outcome {
  kAborted,       ///< something failed on the way; the recording holds what happened until then
  kCollision,     ///< touched something, whatever came after
  kUnjudged,      ///< no truth told whether it touched anything, as on hardware
  kGoal,          ///< reached the goal and touched nothing
  kTimeout,       ///< did not, within the time there was
  kPlannerFailed  ///< did not, and was never given a plan
};
inline constexpr Outcome kAllOutcomes[] = {Outcome::kAborted,  Outcome::kCollision,
                                           Outcome::kUnjudged, Outcome::kGoal,
                                           Outcome::kTimeout,  Outcome::kPlannerFailed};

/// "aborted", "collision", "unjudged", "goal", "timeout", "planner_failed".
std::string ToString(Outcome outcome);
/// None for any other word.
std::optional<Outcome> OutcomeFromString(const std::string& word);

/// How an episode with these metrics ended, whatever it touched: goal, timeout or planner_failed.
Outcome Ending(const std::map<std::string, double>& metrics);

/// The outcome's word and, if something was touched, what: "collision with hsr". Of what nobody
/// judged, also how it ended: "unjudged, timeout".
std::string Tell(Outcome outcome, const std::string& touched, Outcome ending);

/// The outcome of a whole recording whose metrics are filled. @param reached the goal.
Outcome Judge(const record::Recording& recording, bool reached);

}  // namespace sidestep::bench
