#include "sidestep/sim/ray_caster.h"

#include <algorithm>
#include <limits>

#include "sidestep/sim/mujoco_pose.h"

namespace sidestep::sim {
namespace {

bool Holds(const std::vector<int>& sorted, int geom) {
  return std::binary_search(sorted.begin(), sorted.end(), geom);
}

}  // namespace

RayCaster::RayCaster(const mjModel& model) : model_(model), geoms_(FindWorldGeoms(model)) {
  for (const auto* const role : {&geoms_.robot, &geoms_.floor, &geoms_.fixed, &geoms_.moving}) {
    solids_.insert(solids_.end(), role->begin(), role->end());
  }
}

bool RayCaster::IsRobot(int geom) const { return Holds(geoms_.robot, geom); }
bool RayCaster::IsFloor(int geom) const { return Holds(geoms_.floor, geom); }

std::optional<RayHit> RayCaster::Cast(const mjData& data, const Eigen::Vector3d& p_WStart,
                                      const Eigen::Vector3d& direction_W) const {
  RayHit nearest{std::numeric_limits<double>::infinity(), -1};
  for (const int geom : solids_) {
    // A plane has no bounding sphere; MuJoCo says so by a radius of 0.
    if (const double radius = model_.geom_rbound[geom]; radius > 0) {
      const Eigen::Vector3d p_SG = GeomPosition(data, geom) - p_WStart;
      const double along = p_SG.dot(direction_W);
      if (along + radius < 0 || along - radius > nearest.distance_m ||
          p_SG.squaredNorm() - along * along > radius * radius) {
        continue;
      }
    }
    double distance = -1;
    switch (model_.geom_type[geom]) {
      case mjGEOM_MESH:
        distance = mj_rayMesh(&model_, &data, geom, p_WStart.data(), direction_W.data());
        break;
      case mjGEOM_HFIELD:
        distance = mj_rayHfield(&model_, &data, geom, p_WStart.data(), direction_W.data());
        break;
      default:
        distance = mju_rayGeom(data.geom_xpos + 3 * geom, data.geom_xmat + 9 * geom,
                               model_.geom_size + 3 * geom, p_WStart.data(), direction_W.data(),
                               model_.geom_type[geom]);
    }
    if (distance >= 0 && distance < nearest.distance_m) nearest = {distance, geom};
  }
  if (nearest.geom < 0) return std::nullopt;
  return nearest;
}

}  // namespace sidestep::sim
