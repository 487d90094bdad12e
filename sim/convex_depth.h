#pragma once

#include <Eigen/Geometry>

#include "sidestep/sim/convex_solid.h"

namespace sidestep::sim {

/// How deep two solids overlap [m]: the shortest way to shift one so that they only touch; 0 if
/// they are apart. As a solid moves, it changes no faster than the solid's points do.
///
/// It is the least reach, over all unit directions, of the Minkowski difference of the two. Solids
/// whose cores are apart: the radii less ConvexDistance's distance of the cores. Otherwise the
/// sphere of directions is searched by branch and bound, since the reach has many local minima:
/// within a triangle of directions it is at least that of the three points found farthest at its
/// corners. Off by at most 1e-7 m; by some 1e-6 of the solids' size where a whole circle of
/// directions is equally good (cylinders on one axis), 1e-3 where the whole sphere is (equal round
/// ellipsoids about one centre).
///
/// @param X_AB where solid b is, in the frame of solid a.
double ConvexDepth(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB);

}  // namespace sidestep::sim
