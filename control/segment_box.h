#pragma once

#include <Eigen/Core>

namespace sidestep::control {

/// The least distance between the segment from `a` to `b` and the box |x| <= half, all in the box's
/// frame [m]; 0 where they meet. Exact: along the segment, the squared distance is convex and made
/// of parabolas.
double SegmentBoxDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& half) noexcept;

}  // namespace sidestep::control
