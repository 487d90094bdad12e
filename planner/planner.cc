#include "sidestep/planner/planner.h"

#include <algorithm>
#include <cstdint>
#include <exception>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sidestep/core/goal.h"
#include "sidestep/planner/direct_time.h"
#include "sidestep/robot/tolerance_scale.h"

namespace sidestep::planner {
namespace {

PlanStatus StatusOf(const Verdict& verdict, bool is_short, bool converged) {
  if (!verdict.is_free()) return PlanStatus::kInCollision;
  if (!verdict.keeps_limits) return PlanStatus::kOverLimits;
  if (is_short) return PlanStatus::kShortOfGoal;
  return converged ? PlanStatus::kSolved : PlanStatus::kNotConverged;
}

}  // namespace

std::string ToString(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kNotConverged:
      return "not_converged";
    case PlanStatus::kShortOfGoal:
      return "short_of_goal";
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
    : robot_(robot), settings_(settings), clearance_meter_(robot_) {
  CheckPlannerSettings(settings);
}

double Planner::DirectTime_s(const Eigen::VectorXd& q_start, const Eigen::VectorXd& q_goal) const {
  return planner::DirectTime_s(robot_, settings_, q_start, q_goal);
}

PlanBudget Planner::BudgetOf(int work) const {
  const std::int64_t iterations = std::int64_t{work} * capabilities().iterations_for_one;
  PlanBudget budget;
  budget.iterations =
      static_cast<int>(std::min<std::int64_t>(iterations, std::numeric_limits<int>::max()));
  return budget;
}

PlanResult Planner::Plan(const PlanRequest& request) const {
  CheckPlanRequest(request, robot_.num_joints());
  PlanJudge judge(robot_, clearance_meter_, settings_, request);
  PlanResult result;
  PlanAnswer answer;
  try {
    answer = DoPlan(request, judge);
  } catch (const std::exception& error) {
    result.reason = error.what();
    return result;
  }
  result.converged = answer.converged;
  result.iterations = answer.iterations;
  result.spent = std::max(answer.spent, answer.iterations);
  result.progress = std::move(answer.progress);
  if (!answer.trajectory) {
    if (request.budget.IsSpent(result.spent)) result.status = PlanStatus::kTimedOut;
    result.reason = answer.why_none.empty() ? "found no plan" : std::move(answer.why_none);
    return result;
  }
  result.reason = WhyNoAnswer(request, *answer.trajectory);
  if (!result.reason.empty()) return result;

  const Verdict verdict = judge.Judge(*answer.trajectory);
  const bool is_short =
      capabilities().reaches_goal &&
      !EndsAtGoal(*answer.trajectory, request.q_goal, robot::ToleranceScale(robot_));
  result.status = StatusOf(verdict, is_short, answer.converged);
  if (is_short) {
    result.reason = answer.why_short.empty() ? "it ends elsewhere than at the goal"
                                             : std::move(answer.why_short);
  }
  result.trajectory = std::move(answer.trajectory);
  result.cost = answer.cost;
  result.clearance = verdict.clearance;
  result.limit_use = verdict.limit_use;
  result.limit_share = verdict.limit_share;
  return result;
}

}  // namespace sidestep::planner
