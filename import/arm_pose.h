#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/robot/arm_description.h"

namespace sidestep::imports {

/// X_BL of each joint's link, in the frame of the base.
std::vector<Pose> LinkPosesAt(const robot::ArmDescription& arm, const Eigen::VectorXd& q);

/// Configurations spread evenly between the limits, always the same; a joint without limits is
/// turned by half a turn both ways, or slid by a metre.
std::vector<Eigen::VectorXd> SampleConfigurations(const robot::ArmDescription& arm, int count);

/// Roll, pitch, yaw of a rotation, so that Pose::FromRollPitchYaw gives it again to rounding,
/// whatever the pitch.
Eigen::Vector3d RollPitchYawOf(const Eigen::Matrix3d& R);

}  // namespace sidestep::imports
