#pragma once

#include <Eigen/Core>

#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::hardware {

/// A tenth of the robot's speed.
inline constexpr double kSlowShare = 0.1;

/// Straight in the joints' space from `from` to `to`, at rest at both ends, all joints in one time:
/// the polynomial of least jerk, no joint faster than kSlowShare of its limit. Shapes n.
Trajectory SlowMove(const robot::RobotModel& robot, const Eigen::VectorXd& from,
                    const Eigen::VectorXd& to);

}  // namespace sidestep::hardware
