// What is sent stays far from the limits at which the robot would stop by itself.
#include <fmt/core.h>

#include <algorithm>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

struct Use {
  const char* metric;
  const char* what;
  double most;
};
constexpr Use kUses[] = {{"velocity_use", "velocity", kMostVelocityShare},
                         {"acceleration_use", "acceleration", 0.5},
                         {"jerk_use", "jerk", 0.1}};
// Differences of sent positions are wrong by some 1e-15 rad, divided by 1e-9 s^3.
constexpr double kRounding = 1e-6;

Facts MeasureMotionLimits(const ValidationRun& run) {
  Facts facts;
  for (const Use& use : kUses) facts[use.metric] = run.result.recording.metrics.at(use.metric);
  return facts;
}

// Where packets are lost, the robot makes up what is missing, and that is not what was sent.
bool IsJudgedByLimits(const RunRow& row) {
  return !IsOfGroup(row, validation_group::kPrediction) &&
         !IsOfGroup(row, validation_group::kFault) &&
         !row.factors.at("timing").starts_with("loss_");
}

ItemFinding JudgeMotionLimits(const Evidence& evidence) {
  ItemFinding finding{ItemVerdict::kPass, "", {}};
  for (const auto& [metric, what, most] : kUses) {
    const std::vector<Told> told = LargestFirst(evidence, metric, IsJudgedByLimits);
    if (told.empty()) return NothingRun("the robot has no such limits");
    finding.evidence += fmt::format("{}{} {:.1f} %", finding.evidence.empty() ? "at most: " : ", ",
                                    what, 100 * told.front().value);
    if (told.front().value > most + kRounding) {
      finding.verdict = ItemVerdict::kFail;
      for (NamedCase& one : WorstOf(told, most + kRounding, "{:.3f} of the limit")) {
        finding.worst.push_back({one.name, std::string(what) + " " + one.what});
      }
    }
  }
  return finding;
}

}  // namespace

ValidationItem MotionLimitsItem() {
  return {2,
          "velocity, acceleration and jerk of what is sent",
          "at most 50 %, 50 % and 10 % of the robot's limits, by backward differences",
          "libfranka keeps three lost packets in reserve (rate_limiting.h)",
          MeasureMotionLimits,
          JudgeMotionLimits};
}

}  // namespace sidestep::bench
