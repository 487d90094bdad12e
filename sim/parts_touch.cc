#include "sidestep/sim/parts_touch.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sidestep::sim {

PartsTouch::PartsTouch(const std::vector<ConvexHull>& parts) {
  for (const ConvexHull& hull : parts) {
    Part part;
    part.p_GM = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& p_GV : hull.vertices) part.p_GM += p_GV;
    part.p_GM /= static_cast<double>(hull.vertices.size());
    part.solid.core = ConvexSolid::Core::kHull;
    for (const Eigen::Vector3d& p_GV : hull.vertices) {
      const Eigen::Vector3d p_MV = p_GV - part.p_GM;
      part.solid.vertices.push_back(p_MV);
      part.radius_m = std::max(part.radius_m, p_MV.norm());
    }
    parts_.push_back(std::move(part));
  }
}

bool PartsTouch::operator()(const Eigen::Isometry3d& X_GW, const Eigen::Vector3d& p_WCenter,
                            double edge_m) const {
  const Eigen::Vector3d p_GC = X_GW * p_WCenter;
  ConvexSolid cube;
  cube.core = ConvexSolid::Core::kBox;
  cube.size_m.setConstant(edge_m / 2 - kOnSurface_m);
  const double cube_radius_m = std::sqrt(3.0) / 2 * edge_m;
  return std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
    Eigen::Isometry3d X_MC = Eigen::Isometry3d::Identity();
    X_MC.linear() = X_GW.linear();
    X_MC.translation() = p_GC - part.p_GM;
    if (X_MC.translation().norm() > part.radius_m + cube_radius_m) return false;
    return ConvexDistance(part.solid, cube, X_MC) <= 0;
  });
}

}  // namespace sidestep::sim
