#pragma once

#include <Eigen/Geometry>

#include "sidestep/sim/convex_solid.h"

namespace sidestep::sim {

/// The least distance between two solids [m], 0 if they overlap; off by at most 1e-9 m.
///
/// The distance of the cores is found by the algorithm of Gilbert, Johnson and Keerthi (IEEE
/// Journal of Robotics and Automation 4(2):193-203, 1988). The nearest point of a simplex is sought
/// among all its faces instead of by case distinctions, so that parallel faces and edges, which are
/// common in scenes and upset quicker variants, need no special care; and it ends when the
/// separating plane it has found proves the result.
///
/// @param X_AB where solid b is, in the frame of solid a.
double ConvexDistance(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB);

/// The same for their cores alone.
double CoreDistance(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB);

}  // namespace sidestep::sim
