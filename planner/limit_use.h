#pragma once

#include "core/trajectory.h"
#include "robot/robot_model.h"

namespace sidestep {

/// The largest share of a robot's limits that a motion uses; above 1 it exceeds one. Infinite
/// limits use nothing.
struct LimitUse {
  double position = 0;      ///< |q - middle| / half the range, at support states
  double velocity = 0;      ///< |v| / v_max, the exact extremes of the cubics
  double acceleration = 0;  ///< |a| / a_max, likewise
};

/// From support state `first_state` to the end.
LimitUse MeasureLimitUse(const RobotModel& robot, const Trajectory& trajectory, int first_state);

}  // namespace sidestep
