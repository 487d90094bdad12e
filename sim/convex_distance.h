#pragma once

#include <Eigen/Geometry>
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

}  // namespace sidestep::sim
