#pragma once

#include <Eigen/Core>

#include "sidestep/robot/robot_model.h"

namespace sidestep::robot {

/// Tolerances of positions and speeds are given in rad and rad/s. Of a joint that slides, one rad
/// of them is this: what a turn of 1 rad moves at the end of a forearm [m].
inline constexpr double kSlidePerTurn_m = 0.25;

/// What one rad of a tolerance is for each number of a configuration (shape n): 1 of a joint that
/// turns, kSlidePerTurn_m of one that slides.
inline Eigen::VectorXd ToleranceScale(const RobotModel& robot) {
  Eigen::VectorXd scale(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) {
    const int joint = robot.moving_joints()[static_cast<std::size_t>(i)];
    const JointKind kind = robot.joints()[static_cast<std::size_t>(joint)].kind;
    scale(i) = kind == JointKind::kPrismatic ? kSlidePerTurn_m : 1;
  }
  return scale;
}

}  // namespace sidestep::robot
