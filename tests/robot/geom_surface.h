#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>

#include "sidestep/core/shape.h"

namespace sidestep::robot {

/// Points all over a shape's surface, edges and corners included, in the shape's own frame [m].
/// Neighbours are a few mm apart for the shapes of a robot's link. Shape 3 x N.
Eigen::Matrix3Xd SampleSurface(const Shape& shape);

/// The shape of a model's geom. @throws std::invalid_argument if it is not a primitive.
Shape ShapeOf(const mjModel& model, int geom);

}  // namespace sidestep::robot
