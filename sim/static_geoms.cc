#include "sidestep/sim/static_geoms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "sidestep/sim/geom_distance.h"
#include "sidestep/sim/geom_solids.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/mujoco_pose.h"
#include "sidestep/sim/world_file.h"
#include "sidestep/sim/world_geoms.h"

namespace sidestep::sim {
namespace {

constexpr double kLevel = 1e-6;  // rad

class GeomReader {
 public:
  GeomReader(const std::string& file, const mjModel& model, const mjData& data)
      : file_(file), model_(model), data_(data) {}

  void Read(int geom) {
    if (!IsFixed(model_, model_.geom_bodyid[geom])) return NoteMover(geom);
    switch (model_.geom_type[geom]) {
      case mjGEOM_PLANE:
        return ReadPlane(geom);
      case mjGEOM_HFIELD:
        return LeaveOut(geom, "a height field is no shape of scenarios");
      case mjGEOM_MESH:
        return ReadMesh(geom);
      default:
        if (const auto shape = ShapeOfGeom(model_, geom)) Add(geom, *shape);
    }
  }

  StaticGeoms Take() { return std::move(geoms_); }

 private:
  std::string NameOf(int geom) const {
    const char* const name = mj_id2name(&model_, mjOBJ_GEOM, geom);
    return name != nullptr ? name : GeomOwner(model_, geom);
  }

  void NoteMover(int geom) {
    const int body = model_.geom_bodyid[geom];
    if (!movers_.insert(body).second) return;
    const char* const name = mj_id2name(&model_, mjOBJ_BODY, body);
    geoms_.left_out.push_back(file_ + ": body '" + (name != nullptr ? name : "") +
                              "': it moves, and how is not in the file");
  }

  void ReadPlane(int geom) {
    const Pose X_WG = GeomPose(data_, geom);
    const Eigen::Vector3d up = X_WG.Rotate(Eigen::Vector3d::UnitZ());
    if (up.head<2>().norm() > kLevel || up.z() < 0) {
      return LeaveOut(geom, "a plane that is not level");
    }
    const double height_m = X_WG.translation().z();
    if (geoms_.floor_m && *geoms_.floor_m > height_m) {
      return LeaveOut(geom, "a plane below another");
    }
    geoms_.floor_m = height_m;
  }

  void ReadMesh(int geom) {
    try {
      const ConvexHull hull = HullOfMesh(model_, model_.geom_dataid[geom]);
      Add(geom, scenarios::MakeConvexMesh(hull.vertices));
    } catch (const std::invalid_argument& fault) {
      LeaveOut(geom, std::string("a mesh whose vertices ") + fault.what());
    }
  }

  void Add(int geom, const Shape& shape) {
    geoms_.solids.push_back({NameOf(geom), {shape, GeomPose(data_, geom)}});
  }

  void LeaveOut(int geom, const std::string& why) {
    geoms_.left_out.push_back(file_ + ": geom '" + NameOf(geom) + "': " + why);
  }

  const std::string& file_;
  const mjModel& model_;
  const mjData& data_;
  std::set<int> movers_;
  StaticGeoms geoms_;
};

}  // namespace

StaticGeoms ReadStaticGeoms(const std::string& path) {
  CheckWorldFile(path);
  const MujocoModelPtr model = LoadMujocoFile(path);
  const MujocoDataPtr data = MakeMujocoData(*model);
  mj_kinematics(model.get(), data.get());
  GeomReader reader(path, *model, *data);
  for (int geom = 0; geom < model->ngeom; ++geom) {
    const bool is_solid = model->geom_contype[geom] != 0 || model->geom_conaffinity[geom] != 0;
    if (is_solid) reader.Read(geom);
  }
  return reader.Take();
}

double FootHeight(const World& world) {
  constexpr double kRoom_m = 0.02;
  const WorldGeoms geoms = FindWorldGeoms(world.model());
  const int floor = geoms.floor.at(0);
  const GeomDistance distance(world.model());
  double fixed_m = std::numeric_limits<double>::infinity(), any_m = fixed_m;
  for (const int geom : geoms.robot) {
    const double above_m =
        distance.Distance(world.data(), geom, floor) - distance.Depth(world.data(), geom, floor);
    any_m = std::min(any_m, above_m);
    const bool is_fixed = IsFixed(world.model(), world.model().geom_bodyid[geom]);
    if (is_fixed) fixed_m = std::min(fixed_m, above_m);
  }
  return GeomPosition(world.data(), floor).z() +
         (std::isfinite(fixed_m) ? fixed_m : any_m - kRoom_m);
}

}  // namespace sidestep::sim
