#pragma once

#include <Eigen/Core>
#include <vector>

namespace sidestep::sim {

/// A bounded convex solid: everything within `radius_m` of a core. Lengths in metres.
struct ConvexSolid {
  enum class Core { kPoint, kSegment, kBox, kCylinder, kEllipsoid, kHull };
  Core core = Core::kPoint;
  /// Of the core, in its own frame. Segment: half its length, along z, in z. Box: half edges.
  /// Cylinder: radius in x, half the length, along z, in z. Ellipsoid: semi-axes.
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> vertices;  ///< of a hull, at least one; anywhere in the frame
  double radius_m = 0;
};

/// The point of a solid's core that is farthest along n, which is not zero.
Eigen::Vector3d CoreSupport(const ConvexSolid& solid, const Eigen::Vector3d& n);

}  // namespace sidestep::sim
