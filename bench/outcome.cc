#include "sidestep/bench/outcome.h"

#include <cmath>

namespace sidestep::bench {

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

std::string Tell(Outcome outcome, const std::string& touched) {
  const char* const link = outcome == Outcome::kCollision ? " with " : ", touched ";
  return ToString(outcome) + (touched.empty() ? "" : link + touched);
}

Outcome Judge(const record::Recording& recording, bool reached) {
  if (!std::isnan(recording.metrics.at("first_contact_s"))) return Outcome::kCollision;
  if (recording.truth.empty()) return Outcome::kUnjudged;
  if (reached) return Outcome::kGoal;
  const bool planned = recording.metrics.at("plans_accepted") > 0;
  return planned ? Outcome::kTimeout : Outcome::kPlannerFailed;
}

}  // namespace sidestep::bench
