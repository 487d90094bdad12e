#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "sidestep/core/pose.h"
#include "sidestep/core/random.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::imports {

/// Where a link is to be.
struct LinkTarget {
  int link = 0;  ///< the joint that carries it
  Pose X_WL;
};

/// The configuration that a damped least-squares search from `q` leads to: within the position
/// limits, its link within 1e-6 m and 1e-6 rad of the target; none if it does not get there.
/// Source: Y. Nakamura, H. Hanafusa, "Inverse kinematic solutions with singularity robustness",
/// J. Dyn. Sys. Meas. Control 108(3):163-171, 1986; the damping goes down with the error.
/// @param q of the robot's shape; clamped to the limits.
std::optional<Eigen::VectorXd> ReachFrom(const robot::RobotModel& robot, const LinkTarget& target,
                                         Eigen::VectorXd q);

/// Of the solutions that are found from `q_near`, from the middle of the limits and from
/// `num_starts` random configurations, and that `is_good`, the one that is nearest to `q_near` by
/// its farthest joint.
std::optional<Eigen::VectorXd> SolvePose(
    const robot::RobotModel& robot, const LinkTarget& target, const Eigen::VectorXd& q_near,
    int num_starts, RandomStream& random,
    const std::function<bool(const Eigen::VectorXd&)>& is_good);

/// A configuration drawn evenly from the position limits; of a joint without limits, from a turn
/// either way.
Eigen::VectorXd RandomConfiguration(const robot::RobotModel& robot, RandomStream& random);

}  // namespace sidestep::imports
