#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "sidestep/core/solid.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sim/geom_solids.h"

namespace sidestep::sim {

/// The solids of one link of a robot and of all that is fixed to it, in the link's frame, and its
/// spheres.
struct RigidLink {
  int link = -1;                        ///< by its joint; -1: the base
  std::vector<PlacedShape> shapes;      ///< X_WO: in the link's frame
  std::vector<ConvexHull> hulls;        ///< of meshes
  std::vector<std::string> shape_body;  ///< the body of the MJCF that each shape belongs to ...
  std::vector<std::string> hull_body;   ///< ... and each hull
  std::vector<robot::CollisionSphere> spheres;  ///< p_LS: in the frame of `link`

  bool has_solids() const { return !shapes.empty() || !hulls.empty(); }
};

/// What a robot is made of: the base, then each link whose joint moves, in the order of the joints;
/// those with neither solids nor spheres are left out.
/// @param model of its MJCF alone, which agrees with robot.yaml; of X_WB the identity.
std::vector<RigidLink> FindRigidLinks(const robot::RobotModel& robot, const mjModel& model);

}  // namespace sidestep::sim
