// The robot itself has nothing to object to: no reflex, no violated condition of its interface.
#include <fmt/core.h>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

// A brake of the supervisor's ends an episode as well; the loop says of it that the robot stopped.
constexpr const char* kSupervised = "the robot stopped: ";

Facts MeasureRobotErrors(const ValidationRun& run) {
  if (!run.one.on_the_wire) return {};
  const bool failed =
      run.result.outcome == Outcome::kAborted && !run.result.reason.starts_with(kSupervised);
  return {{"robot_errors", failed ? 1 : 0}};
}

bool IsNominal(const RunRow& row) {
  return IsOfGroup(row, validation_group::kEnvelope) || IsOfGroup(row, validation_group::kTiming);
}

ItemFinding JudgeRobotErrors(const Evidence& evidence) {
  const std::vector<Told> told = LargestFirst(evidence, "robot_errors", IsNominal);
  if (told.empty()) {
    return NothingRun("no episode was run at the robot server, which simulates a panda alone");
  }
  ItemFinding finding;
  finding.verdict = SumOf(told) == 0 ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "{} of {} episodes at the robot server, in lock-step, without limiter or filter, some with "
      "1 and 5 % of packets lost, were ended by the robot",
      SumOf(told), told.size());
  for (const Told& one : told) {
    if (one.value == 0 || finding.worst.size() == 3) break;
    finding.worst.push_back({NameOf(*one.row), one.row->error});
  }
  return finding;
}

}  // namespace

ValidationItem RobotErrorsItem() {
  return {1,
          "errors of the robot",
          "none, where nothing fails",
          "Franka's documentation: the necessary conditions of a motion",
          MeasureRobotErrors,
          JudgeRobotErrors};
}

}  // namespace sidestep::bench
