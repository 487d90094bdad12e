#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>

#include "sidestep/core/shape.h"

namespace sidestep::robot {

/// Points all over a shape's surface, edges and corners included, in the shape's own frame [m].
/// Neighbours are a few mm apart for the shapes of a robot's link. Shape 3 x N.
Eigen::Matrix3Xd SampleSurface(const Shape& shape);

/// The same of a model's geom: of a mesh, points on the faces of its hull. In the geom's frame.
Eigen::Matrix3Xd SampleGeom(const mjModel& model, int geom);

/// From a point to a model's geom, negative inside; of a mesh, to the planes of its hull's faces,
/// so that it is the distance only inside and before a face.
double DistanceToGeom(const mjModel& model, int geom, const Eigen::Vector3d& p_GQ);

/// The shape of a model's geom. @throws std::invalid_argument if it is not a primitive.
Shape ShapeOf(const mjModel& model, int geom);

}  // namespace sidestep::robot
