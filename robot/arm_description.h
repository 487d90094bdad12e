#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"
#include "sidestep/robot/joint.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::robot {

/// A convex polyhedron [m]. Every vertex is a corner; triangles are columns of vertex indices,
/// counter-clockwise seen from outside.
struct HullSolid {
  Eigen::Matrix3Xd vertices;
  Eigen::Matrix3Xi triangles;
};

/// What of a link can touch: a convex solid at X_LS in the link's frame.
struct LinkSolid {
  std::variant<Shape, HullSolid> form;
  Pose X_LS;
  std::string source;  ///< where it comes from, for people: the name of a mesh file
};

struct LinkInertia {
  double mass_kg = 0;
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();  ///< [m] the centre of mass
  Eigen::Matrix3d I_C = Eigen::Matrix3d::Zero();   ///< [kg m^2] about it, along the link's axes
};

struct ArmLink {
  std::string name;
  std::optional<LinkInertia> inertia;  ///< none: it weighs nothing, as a mere frame does
  std::vector<LinkSolid> solids;
};

/// What a joint itself does to its motion, without the links.
struct JointDynamics {
  double damping = 0;   ///< N m s/rad, of one that slides N s/m
  double friction = 0;  ///< N m, N
  double armature = 0;  ///< inertia of what turns in the motor, seen behind the gear: kg m^2, kg
};

/// A robot as it is described elsewhere, on its way to becoming robot.yaml and MJCF.
struct ArmDescription {
  std::string name;
  std::string source;                   ///< the file that it was read from
  std::vector<Joint> joints;            ///< parents and what is mimicked before the others
  std::vector<JointLimits> limits;      ///< of each coordinate; infinite where nothing is known
  std::vector<JointDynamics> dynamics;  ///< of each joint
  std::vector<ArmLink> links;           ///< of the base, then of each joint
  std::string tool_link;
  /// Of links (by their joints; -1: the base; first < second) that do not touch each other,
  /// whatever they do.
  std::vector<LinkPair> without_contact;

  /// Of a joint's link; -1: the base's.
  const ArmLink& LinkOf(int joint) const { return links[static_cast<std::size_t>(joint + 1)]; }
};

}  // namespace sidestep::robot
