#pragma once

#include <Eigen/Core>
#include <optional>

#include "sidestep/robot/arm_description.h"

namespace sidestep::imports {

/// The convex hull of points [m], shape 3 x N, finite. None if they span no solid: fewer than four,
/// or all within `kFlat_m` of a plane.
/// By the library Qhull (Barber, Dobkin, Huhdanpaa: The Quickhull Algorithm, ACM TOMS 22(4), 1996).
std::optional<robot::HullSolid> ConvexHullOf(const Eigen::Matrix3Xd& points);
inline constexpr double kFlat_m = 1e-4;

/// A hull of fewer corners, and how far the left out ones stand outside of it at most [m].
struct SimplerHull {
  robot::HullSolid hull;
  double outside_m = 0;
};

/// The hull of at most `max_vertices` (>= 8) of a hull's corners: first those farthest along a few
/// directions, then always the one that stands out farthest of what there is.
SimplerHull Simplify(const robot::HullSolid& hull, int max_vertices);

}  // namespace sidestep::imports
