#include "sidestep/planner/limit_use.h"

#include <algorithm>
#include <cmath>

namespace sidestep::planner {
namespace {

double PositionUse(const robot::JointLimits& limits, double q) {
  if (std::isinf(limits.q_max) || std::isinf(limits.q_min)) return 0;
  const double middle = (limits.q_min + limits.q_max) / 2;
  return std::abs(q - middle) / (limits.q_max - middle);
}

}  // namespace

LimitUse MeasureLimitUse(const std::vector<robot::JointLimits>& all_limits,
                         const Trajectory& trajectory, int first_state) {
  LimitUse use;
  for (int i = 0; i < trajectory.num_joints(); ++i) {
    const robot::JointLimits& limits = all_limits[static_cast<std::size_t>(i)];
    for (int k = first_state; k < trajectory.num_states(); ++k) {
      use.position = std::max(use.position, PositionUse(limits, trajectory.q(i, k)));
      use.velocity = std::max(use.velocity, std::abs(trajectory.v(i, k)) / limits.v_max);
    }
    for (int k = first_state; k + 1 < trajectory.num_states(); ++k) {
      const double dt = trajectory.t_s(k + 1) - trajectory.t_s(k);
      const double dq = trajectory.q(i, k + 1) - trajectory.q(i, k);
      const double v0 = trajectory.v(i, k), v1 = trajectory.v(i, k + 1);
      const double a0 = 6 * dq / (dt * dt) - (4 * v0 + 2 * v1) / dt;
      const double a1 = -6 * dq / (dt * dt) + (2 * v0 + 4 * v1) / dt;
      use.acceleration =
          std::max({use.acceleration, std::abs(a0) / limits.a_max, std::abs(a1) / limits.a_max});
      use.jerk = std::max(use.jerk, std::abs(a1 - a0) / dt / limits.jerk_max);
      if (a0 * a1 < 0) {  // The velocity turns inside, where the acceleration crosses zero.
        const double v_turn = v0 + 0.5 * a0 * dt * a0 / (a0 - a1);
        use.velocity = std::max(use.velocity, std::abs(v_turn) / limits.v_max);
      }
    }
  }
  return use;
}

LimitUse MeasureLimitUse(const robot::RobotModel& robot, const Trajectory& trajectory,
                         int first_state) {
  return MeasureLimitUse(robot.limits(), trajectory, first_state);
}

}  // namespace sidestep::planner
