#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/robot/arm_description.h"

namespace sidestep::imports {

/// A ball in a link's frame; of radius 0, a point.
struct Ball {
  Eigen::Vector3d p_L;
  double radius_m = 0;
};

/// Balls whose convex hull holds a solid: it alone, but for a cylinder, which sticks out nowhere by
/// more than 0.5 % of its radius, and an ellipsoid, which stands for its box.
void AppendBalls(const robot::LinkSolid& solid, std::vector<Ball>* balls);

}  // namespace sidestep::imports
