#pragma once

#include <Eigen/Core>

#include "sidestep/core/shape.h"

namespace sidestep {

/// The gradient of SignedDistance(shape, p_OQ): of unit length, away from the nearest surface
/// outside and towards it inside. Where several surface points are nearest (the middle of a ball,
/// the axis of a capsule, the planes between a box's faces), that of one of them.
///
/// In closed form; of an ellipsoid by central differences, to 1e-6.
Eigen::Vector3d DistanceGradient(const Shape& shape, const Eigen::Vector3d& p_OQ);

}  // namespace sidestep
