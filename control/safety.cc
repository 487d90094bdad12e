#include "sidestep/control/safety.h"

#include "sidestep/core/number_text.h"

namespace sidestep::control {

const char* ToString(SafetyCheck check) {
  switch (check) {
    case SafetyCheck::kPerceptionStale:
      return "perception_stale";
    case SafetyCheck::kObstacleLost:
      return "obstacle_lost";
    case SafetyCheck::kTimeStamps:
      return "time_stamps";
    case SafetyCheck::kSplice:
      return "splice";
    case SafetyCheck::kLimits:
      return "limits";
    case SafetyCheck::kWorkspace:
      return "workspace";
    case SafetyCheck::kClearance:
      return "clearance";
    case SafetyCheck::kStopPath:
      return "stop_path";
    case SafetyCheck::kTracking:
      return "tracking";
    case SafetyCheck::kExternalTorque:
      return "external_torque";
    case SafetyCheck::kLink:
      return "link";
    case SafetyCheck::kRobotMode:
      return "robot_mode";
    case SafetyCheck::kRecovery:
      return "recovery";
    case SafetyCheck::kOperatorStop:
      return "operator_stop";
    case SafetyCheck::kConfiguration:
      return "configuration";
    case SafetyCheck::kSlowAnswer:
      return "slow_answer";
    case SafetyCheck::kClockJump:
      return "clock_jump";
    case SafetyCheck::kObstacleTooFast:
      return "obstacle_too_fast";
    case SafetyCheck::kToolSpeed:
      return "tool_speed";
    case SafetyCheck::kLongStop:
      return "long_stop";
  }
  return "";
}

std::string Describe(const Finding& finding) {
  return std::string(ToString(finding.check)) + " of " + FiniteText("{:.3g}", finding.value) +
         ", allowed " + FiniteText("{:.3g}", finding.limit);
}

const char* ToString(Reaction reaction) {
  switch (reaction) {
    case Reaction::kNone:
      return "none";
    case Reaction::kSlow:
      return "slow";
    case Reaction::kEase:
      return "ease";
    case Reaction::kRefuse:
      return "refuse";
    case Reaction::kHold:
      return "hold";
    case Reaction::kBrake:
      return "brake";
    case Reaction::kAbort:
      return "abort";
  }
  return "";
}

}  // namespace sidestep::control
