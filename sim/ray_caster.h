#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sidestep/sim/world_geoms.h"

namespace sidestep::sim {

/// What a ray meets first.
struct RayHit {
  double distance_m = 0;
  int geom = -1;
};

/// Casts rays against the solids of a world, not against pictures; exact for every primitive.
class RayCaster {
 public:
  /// @param model must outlive this.
  explicit RayCaster(const mjModel& model);

  const WorldGeoms& geoms() const { return geoms_; }
  bool IsRobot(int geom) const;
  bool IsFloor(int geom) const;

  /// From a point along a unit vector, at the poses in `data`. A solid that the point is inside of
  /// is met where the ray leaves it.
  std::optional<RayHit> Cast(const mjData& data, const Eigen::Vector3d& p_WStart,
                             const Eigen::Vector3d& direction_W) const;

 private:
  const mjModel& model_;
  WorldGeoms geoms_;
  std::vector<int> solids_;
};

}  // namespace sidestep::sim
