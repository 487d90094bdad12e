#include "sidestep/sim/picture.h"

#include "sidestep/core/input_error.h"
#include "sidestep/sim/foreign_model.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/mujoco_pose.h"

namespace sidestep::sim {
namespace {

std::string TypeName(int type, const std::string& name) {
  switch (type) {
    case mjGEOM_SPHERE:
      return "sphere";
    case mjGEOM_CAPSULE:
      return "capsule";
    case mjGEOM_ELLIPSOID:
      return "ellipsoid";
    case mjGEOM_CYLINDER:
      return "cylinder";
    case mjGEOM_BOX:
      return "box";
    default:
      throw InputError(name, "a body to be drawn must be made of primitives");
  }
}

}  // namespace

std::vector<PictureGeom> PictureOf(const std::string& path, ModelStore* store) {
  constexpr int kLastGroupDrawn = 2;
  const MujocoModelPtr model = LoadModelFile(path, store);
  model->nconmax = model->njmax = 0;  // nothing but the poses is asked for
  const MujocoDataPtr data = MakeMujocoData(*model);
  mj_kinematics(model.get(), data.get());
  std::vector<PictureGeom> picture;
  for (int i = 0; i < model->ngeom; ++i) {
    if (model->geom_group[i] > kLastGroupDrawn || model->geom_type[i] == mjGEOM_PLANE) continue;
    const int material = model->geom_matid[i];
    const float* rgba = material >= 0 ? model->mat_rgba + 4 * material : model->geom_rgba + 4 * i;
    picture.push_back({TypeName(model->geom_type[i], path),
                       Eigen::Map<const Eigen::Vector3d>(model->geom_size + 3 * i),
                       GeomPose(*data, i), Eigen::Map<const Eigen::Vector4f>(rgba)});
  }
  return picture;
}

}  // namespace sidestep::sim
