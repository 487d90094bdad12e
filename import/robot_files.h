#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/robot/arm_description.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::imports {

/// Pairs of links, by the joints that carry them; -1: the base.
using LinkPairs = std::vector<robot::LinkPair>;

/// What robot.yaml holds beyond the arm itself.
struct RobotDetails {
  std::vector<robot::CollisionSphere> spheres;
  std::vector<robot::CollisionCapsule> capsules;  ///< may be empty
  std::vector<int> mount_spheres;
  LinkPairs self_collision;
  Eigen::VectorXd home;
  Eigen::VectorXd stiffness, damping;
  double bandwidth_rad_s = 0;  ///< of the gains
};

/// The links that never move, the base among them, as joints.
std::vector<int> FixedLinks(const robot::ArmDescription& arm);

/// Pairs of links whose contacts are left out: those that stand on the base with those that the
/// first joints carry, which MuJoCo would look for contacts between, and `always`.
LinkPairs PairsWithoutContact(const robot::ArmDescription& arm, const LinkPairs& always);

/// The MJCF of an arm, as docs/robots.md wants it: it refers to no other file.
std::string MjcfText(const robot::ArmDescription& arm, const LinkPairs& without_contact);

/// The robot.yaml of an arm.
std::string RobotYamlText(const robot::ArmDescription& arm, const RobotDetails& details);

}  // namespace sidestep::imports
