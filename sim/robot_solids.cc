#include "sidestep/sim/robot_solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/mujoco_pose.h"
#include "sidestep/sim/robot_configuration.h"

namespace sidestep::sim {
namespace {

std::string BodyOf(const mjModel& model, int geom) {
  const char* const name = mj_id2name(&model, mjOBJ_BODY, model.geom_bodyid[geom]);
  return name == nullptr ? "" : name;
}

}  // namespace

std::vector<RigidLink> FindRigidLinks(const robot::RobotModel& robot, const mjModel& model) {
  std::vector<RigidLink> links;
  for (int link = -1; link < static_cast<int>(robot.joints().size()); ++link) {
    if (CarrierOf(robot, link) != link) continue;
    links.emplace_back().link = link;
  }
  const auto carrier = [&links](int link) -> RigidLink& {
    return *std::find_if(links.begin(), links.end(),
                         [link](const RigidLink& one) { return one.link == link; });
  };
  // Any configuration does: what is fixed to a link stays where it is on it.
  RandomStream random(1, "rigid links");
  const Eigen::VectorXd q = DrawConfiguration(robot, random);
  const MujocoDataPtr data = MakeMujocoData(model);
  PutAt(robot, model, q, data.get());
  const std::vector<Pose> X_WL = robot.ComputeLinkPoses(q);
  const auto pose = [&](int link) {
    return link < 0 ? robot.X_WB() : X_WL[static_cast<std::size_t>(link)];
  };
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0) continue;
    RigidLink& link = carrier(CarrierOfBody(robot, model, model.geom_bodyid[geom]));
    const Pose X_LG = pose(link.link).Inverse() * GeomPose(*data, geom);
    if (const std::optional<Shape> shape = ShapeOfGeom(model, geom)) {
      link.shapes.push_back({*shape, X_LG});
      link.shape_body.push_back(BodyOf(model, geom));
    } else if (model.geom_type[geom] == mjGEOM_MESH) {
      ConvexHull hull = HullOfMesh(model, model.geom_dataid[geom]);
      for (Eigen::Vector3d& vertex : hull.vertices) vertex = X_LG * vertex;
      link.hulls.push_back(std::move(hull));
      link.hull_body.push_back(BodyOf(model, geom));
    }
  }
  for (const robot::CollisionSphere& sphere : robot.spheres()) {
    RigidLink& link = carrier(CarrierOf(robot, sphere.link));
    const Pose X_LS = pose(link.link).Inverse() * pose(sphere.link);
    link.spheres.push_back({link.link, X_LS * sphere.p_LS, sphere.radius_m});
  }
  std::erase_if(links,
                [](const RigidLink& link) { return !link.has_solids() && link.spheres.empty(); });
  return links;
}

}  // namespace sidestep::sim
