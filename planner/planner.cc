#include "sidestep/planner/planner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <stdexcept>
#include <utility>

#include "sidestep/core/goal.h"
#include "sidestep/planner/tool_speed.h"
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
  double time_s = 0;
  for (int j = 0; j < robot_.num_joints(); ++j) {
    const robot::JointLimits& joint = robot_.limits()[static_cast<std::size_t>(j)];
    const double way = std::abs(q_goal(j) - q_start(j));
    // Of the cubic over a time T the greatest velocity is 3/2 way / T, acceleration 6 way / T^2.
    if (settings_.velocity_limits) {
      time_s = std::max(time_s, 1.5 * way / (settings_.velocity_scale * joint.v_max));
    }
    if (settings_.acceleration_limits) {
      time_s = std::max(time_s, std::sqrt(6 * way / (settings_.acceleration_scale * joint.a_max)));
    }
  }
  if (std::isfinite(settings_.tool_speed_m_s)) {
    Trajectory second = {Eigen::Vector2d(0, 1), Eigen::MatrixXd(q_start.size(), 2),
                         Eigen::MatrixXd::Zero(q_start.size(), 2)};
    second.q << q_start, q_goal;
    time_s = std::max(time_s, GreatestToolSpeed_m_s(robot_, second, 0) / settings_.tool_speed_m_s);
  }
  return time_s;
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
