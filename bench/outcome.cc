#include "sidestep/bench/outcome.h"

#include <cmath>

namespace sidestep::bench {
namespace {

Outcome EndingOf(bool reached, bool planned) {
  if (reached) return Outcome::kGoal;
  return planned ? Outcome::kTimeout : Outcome::kPlannerFailed;
}

}  // namespace

std::string ToString(Outcome outcome) {
  switch (outcome) {
    case Outcome::kAborted:
      return "aborted";
    case Outcome::kCollision:
      return "collision";
    case Outcome::kUnjudged:
      return "unjudged";
    case Outcome::kGoal:
      return "goal";
    case Outcome::kTimeout:
      return "timeout";
    case Outcome::kPlannerFailed:
      return "planner_failed";
  }
  return "";
}

std::optional<Outcome> OutcomeFromString(const std::string& word) {
  for (const Outcome outcome : kAllOutcomes) {
    if (word == ToString(outcome)) return outcome;
  }
  return std::nullopt;
}

Outcome Ending(const std::map<std::string, double>& metrics) {
  return EndingOf(!std::isnan(metrics.at("time_to_goal_s")), metrics.at("plans_accepted") > 0);
}

std::string Tell(Outcome outcome, const std::string& touched, Outcome ending) {
  const char* const link = outcome == Outcome::kCollision ? " with " : ", touched ";
  return ToString(outcome) + (outcome == Outcome::kUnjudged ? ", " + ToString(ending) : "") +
         (touched.empty() ? "" : link + touched);
}

Outcome Judge(const record::Recording& recording, bool reached) {
  if (!std::isnan(recording.metrics.at("first_contact_s"))) return Outcome::kCollision;
  if (recording.truth.empty()) return Outcome::kUnjudged;
  return EndingOf(reached, recording.metrics.at("plans_accepted") > 0);
}

}  // namespace sidestep::bench
