#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>

#include "sidestep/core/pose.h"
#include "sidestep/core/random.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::sim {

/// A random configuration between the position limits; a joint without one is moved up to 3 rad (or
/// m) that way.
Eigen::VectorXd DrawConfiguration(const robot::RobotModel& robot, RandomStream& random);

/// Puts the joints of a robot's model, those that mimic others with them, where q says, and
/// computes where everything is. @param model of its MJCF alone, which agrees with robot.yaml.
void PutAt(const robot::RobotModel& robot, const mjModel& model, const Eigen::VectorXd& q,
           mjData* data);

/// The link that carries a link along: the next one towards the base whose joint is not fixed (by
/// that joint; -1: the base).
int CarrierOf(const robot::RobotModel& robot, int link);

/// The same of a body of the model.
int CarrierOfBody(const robot::RobotModel& robot, const mjModel& model, int body);

/// "hand", "link0", ...: the link of a joint, or the base (-1).
const std::string& LinkName(const robot::RobotModel& robot, int link);

}  // namespace sidestep::sim
