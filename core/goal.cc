#include "sidestep/core/goal.h"

namespace sidestep {
namespace {

constexpr double kTimeEpsilon_s = 1e-9;  // times are sums of ticks, rounded

}  // namespace

bool IsAtGoal(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& q_goal) {
  return (q - q_goal).cwiseAbs().maxCoeff() <= kGoalTolerance_rad &&
         v.cwiseAbs().maxCoeff() <= kGoalSpeed_rad_s;
}

GoalWatch::GoalWatch(const Eigen::VectorXd& q_goal, double dwell_s)
    : q_goal_(q_goal), dwell_s_(dwell_s) {}

void GoalWatch::Observe(EpisodeTime t, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  if (dwelt_) return;
  if (!IsAtGoal(q, v, q_goal_)) {
    arrived_.reset();
    return;
  }
  if (!arrived_) arrived_ = t;
  if ((t - *arrived_).seconds() >= dwell_s_ - kTimeEpsilon_s) dwelt_ = t;
}

}  // namespace sidestep
