#pragma once

#include "core/trajectory.h"
#include "robot/robot_model.h"

namespace sidestep {

/// The largest share of the robot's limits that a motion uses, from support state `first_state` to
/// its end: of |v| / v_max, |a| / a_max, and |q - middle| / half the range. Above 1 it exceeds one;
/// infinite limits use nothing. Velocity and acceleration are the exact extremes of each cubic,
/// positions are taken at support states.
double MeasureLimitUse(const RobotModel& robot, const Trajectory& trajectory, int first_state);

}  // namespace sidestep
