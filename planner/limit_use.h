#pragma once

#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// The largest share of a robot's limits that a motion uses; above 1 it exceeds one. Infinite
/// limits use nothing.
struct LimitUse {
  double position = 0;      ///< |q - middle| / half the range, at support states
  double velocity = 0;      ///< |v| / v_max, the exact extremes of the cubics
  double acceleration = 0;  ///< |a| / a_max, likewise
};

/// From support state `first_state` to the end.
LimitUse MeasureLimitUse(const robot::RobotModel& robot, const Trajectory& trajectory,
                         int first_state);

}  // namespace sidestep::planner
