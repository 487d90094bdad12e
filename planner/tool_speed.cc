#include "sidestep/planner/tool_speed.h"

#include <algorithm>

namespace sidestep::planner {

double GreatestToolSpeed_m_s(const robot::RobotModel& robot, const Trajectory& trajectory,
                             int first_state) {
  constexpr int kLeastInAll = 100, kLeastOfOne = 4;
  const int intervals = trajectory.num_states() - 1 - first_state;
  if (intervals < 1) return 0;
  const int steps = std::max(kLeastOfOne, (kLeastInAll + intervals - 1) / intervals);
  const auto tool_at = [&](double t_s) {
    return robot.ComputeToolPose(Sample(trajectory, HorizonOffset(t_s)).q).translation();
  };
  double greatest_m_s = 0;
  Eigen::Vector3d p_WT = tool_at(trajectory.t_s(first_state));
  for (int k = first_state; k + 1 < trajectory.num_states(); ++k) {
    const double step_s = (trajectory.t_s(k + 1) - trajectory.t_s(k)) / steps;
    for (int i = 1; i <= steps; ++i) {
      const Eigen::Vector3d next_WT = tool_at(trajectory.t_s(k) + i * step_s);
      greatest_m_s = std::max(greatest_m_s, (next_WT - p_WT).norm() / step_s);
      p_WT = next_WT;
    }
  }
  return greatest_m_s;
}

}  // namespace sidestep::planner
