#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"

namespace sidestep {

/// Everything below a plane: the points p of W with normal . p < offset.
struct HalfSpace {
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();  ///< out of the solid, of unit length
  double offset_m = 0;
};

/// A shape where it stands.
struct PlacedShape {
  Shape shape;
  Pose X_WO;
};

/// Solids that never move and are known exactly, not by cells of a map.
struct StaticSolids {
  std::vector<PlacedShape> shapes;
  std::vector<HalfSpace> half_spaces;
};

/// The signed distance from a point to the plane [m]; negative inside the half-space.
/// (In this order of operations wherever it is computed, so that all answers have the same bits.)
inline double SignedDistance(const HalfSpace& solid, const Eigen::Vector3d& p_WQ) {
  const Eigen::Vector3d& n = solid.normal_W;
  return ((n.x() * p_WQ.x() + n.y() * p_WQ.y()) + n.z() * p_WQ.z()) - solid.offset_m;
}

}  // namespace sidestep
