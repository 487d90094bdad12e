#include "sidestep/planner/direct_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sidestep/core/trajectory.h"
#include "sidestep/planner/tool_speed.h"

namespace sidestep::planner {

double DirectTime_s(const robot::RobotModel& robot, const PlannerSettings& settings,
                    const Eigen::VectorXd& q_start, const Eigen::VectorXd& q_goal) {
  double time_s = 0;
  for (int j = 0; j < robot.num_joints(); ++j) {
    const robot::JointLimits& joint = robot.limits()[static_cast<std::size_t>(j)];
    const double way = std::abs(q_goal(j) - q_start(j));
    // Of the cubic over a time T the greatest velocity is 3/2 way / T, acceleration 6 way / T^2.
    if (settings.velocity_limits) {
      time_s = std::max(time_s, 1.5 * way / (settings.velocity_scale * joint.v_max));
    }
    if (settings.acceleration_limits) {
      time_s = std::max(time_s, std::sqrt(6 * way / (settings.acceleration_scale * joint.a_max)));
    }
  }
  if (std::isfinite(settings.tool_speed_m_s)) {
    Trajectory second = {Eigen::Vector2d(0, 1), Eigen::MatrixXd(q_start.size(), 2),
                         Eigen::MatrixXd::Zero(q_start.size(), 2)};
    second.q << q_start, q_goal;
    time_s = std::max(time_s, GreatestToolSpeed_m_s(robot, second, 0) / settings.tool_speed_m_s);
  }
  return time_s;
}

}  // namespace sidestep::planner
