#include "sidestep/core/goal.h"

namespace sidestep {
namespace {

constexpr double kTimeEpsilon_s = 1e-9;  // times are sums of ticks, rounded

}  // namespace

double LargestDifference(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                         const Eigen::VectorXd& scale) {
  if (scale.size() == 0) return (a - b).cwiseAbs().maxCoeff();
  return (a - b).cwiseAbs().cwiseQuotient(scale).maxCoeff();
}

bool IsAtGoal(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& q_goal,
              const Eigen::VectorXd& scale) {
  return LargestDifference(q, q_goal, scale) <= kGoalTolerance_rad &&
         LargestDifference(v, Eigen::VectorXd::Zero(v.size()), scale) <= kGoalSpeed_rad_s;
}

bool EndsAtGoal(const Trajectory& plan, const Eigen::VectorXd& q_goal,
                const Eigen::VectorXd& scale) {
  return LargestDifference(plan.q.rightCols<1>(), q_goal, scale) <= kPlannedGoalTolerance_rad;
}

GoalWatch::GoalWatch(const Eigen::VectorXd& q_goal, double dwell_s, const Eigen::VectorXd& scale)
    : q_goal_(q_goal), dwell_s_(dwell_s), scale_(scale) {}

void GoalWatch::Observe(EpisodeTime t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  if (dwelt_) return;
  if (!IsAtGoal(q, v, q_goal_, scale_)) {
    arrived_.reset();
    return;
  }
  if (!arrived_) arrived_ = t;
  if ((t - *arrived_).seconds() >= dwell_s_ - kTimeEpsilon_s) dwelt_ = t;
}

}  // namespace sidestep
