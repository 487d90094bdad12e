#pragma once

#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// The greatest speed of the robot's tool along a motion from support state `first_state` on [m/s],
/// to a thousandth below: of the chords between close moments. 0 where there is no motion.
double GreatestToolSpeed_m_s(const robot::RobotModel& robot, const Trajectory& trajectory,
                             int first_state);

}  // namespace sidestep::planner
