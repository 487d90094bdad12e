#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "sidestep/sim/convex_distance.h"
#include "sidestep/sim/geom_solids.h"

namespace sidestep::sim {

/// CubeTouch (core/cell_touch.h) for solids that are given as convex polyhedra: meshes, height
/// fields. Their vertices are of single precision: what overlaps by less than kOnSurface_m does not
/// count.
class PartsTouch {
 public:
  static constexpr double kOnSurface_m = 1e-6;

  PartsTouch() = default;
  /// @param parts in the solid's frame G, together the solid.
  explicit PartsTouch(const std::vector<ConvexHull>& parts);

  /// Whether the solid reaches into the cube with faces across the axes of W.
  bool operator()(const Eigen::Isometry3d& X_GW, const Eigen::Vector3d& p_WCenter,
                  double edge_m) const;

 private:
  struct Part {
    ConvexSolid solid;  // about its own middle M
    Eigen::Vector3d p_GM;
    double radius_m = 0;  // of a ball around M that holds it
  };
  std::vector<Part> parts_;
};

}  // namespace sidestep::sim
