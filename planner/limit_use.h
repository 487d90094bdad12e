#pragma once

#include <vector>

#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// The largest share of limits that a motion uses; above 1 it exceeds one. Infinite limits use
/// nothing.
struct LimitUse {
  double position = 0;      ///< |q - middle| / half the range, at support states
  double velocity = 0;      ///< |v| / v_max, the exact extremes of the cubics
  double acceleration = 0;  ///< |a| / a_max, likewise
  /// Within the cubics, where it is constant. Between two of them the acceleration jumps, and there
  /// is no jerk: what follows the plan has to round the corner.
  double jerk = 0;
};

/// From support state `first_state` to the end.
LimitUse MeasureLimitUse(const std::vector<robot::JointLimits>& limits,
                         const Trajectory& trajectory, int first_state);
LimitUse MeasureLimitUse(const robot::RobotModel& robot, const Trajectory& trajectory,
                         int first_state);

}  // namespace sidestep::planner
