#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/robot/arm_description.h"

namespace sidestep::robot {

/// That a joint does as another does: its position is multiplier * the other's + offset.
struct TreeMimic {
  std::string joint;
  double multiplier = 1, offset = 0;
};

/// A joint between two links of a tree. X_PJ and axis_J as in Joint; what is not known is infinite.
struct TreeJoint {
  std::string name, parent, child;
  JointKind kind = JointKind::kFixed;
  Pose X_PJ;
  Eigen::Vector3d axis_J = Eigen::Vector3d::UnitX();
  double q_min = -std::numeric_limits<double>::infinity();
  double q_max = std::numeric_limits<double>::infinity();
  double v_max = std::numeric_limits<double>::infinity();
  double torque_max = std::numeric_limits<double>::infinity();
  JointDynamics dynamics;
  std::optional<TreeMimic> mimic;
  int line = 1;  ///< in the tree's file
};

struct TreeLink {
  ArmLink link;
  int line = 1;
};

/// All links and joints of a file, before it is chosen which of them become an arm, and move. One
/// link is on no joint, the root; each other is the child of one.
struct RobotTree {
  std::string file;
  std::string root;
  std::vector<TreeLink> links;
  std::vector<TreeJoint> joints;  ///< in the order of the file
  /// Pairs of links that are not to touch each other, by what the file says.
  std::vector<std::pair<std::string, std::string>> without_contact;
  std::vector<std::string> only_drawn;  ///< links that can touch nothing
  std::vector<std::string> notes;       ///< what a person should know of how it was read

  /// nullptr if there is none of that name.
  const TreeLink* FindLink(const std::string& name) const {
    for (const TreeLink& link : links) {
      if (link.link.name == name) return &link;
    }
    return nullptr;
  }
  const TreeJoint* FindJoint(const std::string& name) const {
    for (const TreeJoint& joint : joints) {
      if (joint.name == name) return &joint;
    }
    return nullptr;
  }
  /// The joint that carries a link; nullptr for the root.
  const TreeJoint* JointUnder(const std::string& link) const {
    for (const TreeJoint& joint : joints) {
      if (joint.child == link) return &joint;
    }
    return nullptr;
  }
};

}  // namespace sidestep::robot
