#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <vector>

#include "sidestep/render/gl_context.h"
#include "sidestep/render/image.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::render {

/// Draws the solids of a robot, and its spheres as glass around them, from four sides on white: two
/// pictures above two, from the front (looking against x), left, back and right. The spheres of
/// neighbouring links have other colours.
/// @param model of its MJCF alone, which agrees with robot.yaml.
/// @param size of each of the four, in pixels, >= 16.
Image DrawRobotAndSpheres(const GlContext& gl, const robot::RobotModel& robot, const mjModel& model,
                          const Eigen::VectorXd& q, int size);

}  // namespace sidestep::render
