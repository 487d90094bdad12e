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

std::string Describe(Outcome outcome, bool reached) {
  switch (outcome) {
    case Outcome::kAborted:
      return "ABORTED: could not be completed";
    case Outcome::kCollision:
      return "TOUCHED something";
    case Outcome::kUnjudged:
      return reached ? "at the goal, contact unjudged" : "not at the goal, unjudged";
    case Outcome::kGoal:
      return "reached the goal, touched nothing";
    case Outcome::kTimeout:
      return "did not reach the goal in time";
    case Outcome::kPlannerFailed:
      return "found no plan";
  }
  return "";
}

Outcome Judge(const record::Recording& recording, bool reached) {
  if (!std::isnan(recording.metrics.at("first_contact_s"))) return Outcome::kCollision;
  if (recording.truth.empty()) return Outcome::kUnjudged;
  if (reached) return Outcome::kGoal;
  const bool planned = recording.metrics.at("plans_accepted") > 0;
  return planned ? Outcome::kTimeout : Outcome::kPlannerFailed;
}

}  // namespace sidestep::bench
