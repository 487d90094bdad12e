#include "sidestep/sim/world_geoms.h"

#include <algorithm>

#include "sidestep/sim/world_xml.h"

namespace sidestep::sim {

WorldGeoms FindWorldGeoms(const mjModel& model) {
  const int robot_body = mj_name2id(&model, mjOBJ_BODY, kRobotBody);
  const int floor_geom = mj_name2id(&model, mjOBJ_GEOM, kFloorGeom);
  WorldGeoms geoms;
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_contype[i] == 0 && model.geom_conaffinity[i] == 0) continue;
    const int body = model.geom_bodyid[i];
    if (robot_body >= 0 && model.body_rootid[body] == robot_body) {
      geoms.robot.push_back(i);
    } else if (i == floor_geom) {
      geoms.floor.push_back(i);
    } else {
      (IsFixed(model, body) ? geoms.fixed : geoms.moving).push_back(i);
    }
  }
  return geoms;
}

bool IsFixed(const mjModel& model, int body) {
  // A mocap body is a child of the world without joints, so MuJoCo calls it welded, too.
  return model.body_weldid[body] == 0 && model.body_mocapid[model.body_rootid[body]] < 0;
}

bool IsExcluded(const mjModel& model, int body1, int body2) {
  const int signature = ((std::min(body1, body2) + 1) << 16) + std::max(body1, body2) + 1;
  return std::find(model.exclude_signature, model.exclude_signature + model.nexclude, signature) !=
         model.exclude_signature + model.nexclude;
}

std::string GeomOwner(const mjModel& model, int geom) {
  const int body = model.geom_bodyid[geom];
  const char* name =
      body == 0 ? mj_id2name(&model, mjOBJ_GEOM, geom) : mj_id2name(&model, mjOBJ_BODY, body);
  return name != nullptr ? name : "";
}

}  // namespace sidestep::sim
