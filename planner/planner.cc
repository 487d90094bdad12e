#include "sidestep/planner/planner.h"

#include <exception>
#include <stdexcept>
#include <utility>

namespace sidestep::planner {
namespace {

PlanStatus StatusOf(const Verdict& verdict, bool converged) {
  if (!verdict.is_free()) return PlanStatus::kInCollision;
  if (!verdict.keeps_limits) return PlanStatus::kOverLimits;
  return converged ? PlanStatus::kSolved : PlanStatus::kNotConverged;
}

}  // namespace

std::string ToString(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kNotConverged:
      return "not_converged";
    case PlanStatus::kOverLimits:
      return "over_limits";
    case PlanStatus::kInCollision:
      return "in_collision";
    case PlanStatus::kTimedOut:
      return "timed_out";
    case PlanStatus::kFailed:
      return "failed";
  }
  throw std::invalid_argument("unknown PlanStatus");
}

Planner::Planner(const robot::RobotModel& robot, const PlannerSettings& settings)
    : robot_(robot), settings_(settings) {
  CheckPlannerSettings(settings);
}

PlanResult Planner::Plan(const PlanRequest& request) const {
  CheckPlanRequest(request, robot_.num_joints());
  PlanJudge judge(robot_, settings_, request);
  PlanResult result;
  PlanAnswer answer;
  try {
    answer = DoPlan(request, judge);
  } catch (const std::exception& error) {
    result.reason = error.what();
    return result;
  }
  result.iterations = answer.iterations;
  if (!answer.trajectory) {
    if (request.budget.IsSpent(answer.iterations)) result.status = PlanStatus::kTimedOut;
    result.reason = answer.why_none.empty() ? "found no plan" : std::move(answer.why_none);
    return result;
  }
  result.reason = WhyNoAnswer(request, *answer.trajectory);
  if (!result.reason.empty()) return result;

  const Verdict verdict = judge.Judge(*answer.trajectory);
  result.status = StatusOf(verdict, answer.converged);
  result.trajectory = std::move(answer.trajectory);
  result.cost = answer.cost;
  result.clearance = verdict.clearance;
  result.limit_use = verdict.limit_use;
  return result;
}

}  // namespace sidestep::planner
