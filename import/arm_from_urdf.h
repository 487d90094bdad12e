#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/robot/arm_description.h"

namespace sidestep::import {

/// What a URDF leaves open.
struct ArmChoices {
  std::string name;                   ///< of the robot
  std::string base, tip;              ///< links; empty: found as ArmFromUrdf says
  std::map<std::string, double> fix;  ///< joints that are held where they are told [rad, m]
  std::vector<std::string> package_paths;
  bool cylinders_as_capsules = false;
  bool visuals_as_collisions = false;  ///< of links without a collision
  bool repair_inertia = false;
  bool turn_up_axis = true;      ///< of COLLADA meshes
  int max_hull_vertices = 200;   ///< of a mesh's hull
  std::optional<double> v_max;   ///< of joints whose velocity is 0: rad/s, m/s
  std::optional<double> ramp_s;  ///< in which a joint comes to its greatest speed
};

/// An arm, and what a person should know of how it came about.
struct ImportedArm {
  robot::ArmDescription arm;
  std::vector<std::string> notes;
};

/// Makes an arm of a URDF: everything from the base link on. The joints from base to tip move, with
/// those that mimic one of them; all others are held at 0, or where `fix` says.
/// Base: the root. Tip: the one leaf that the most joints lead to.
/// A mesh becomes its convex hull, of at most `max_hull_vertices` corners.
/// @throws InputError FILE:LINE: KEY: WHY, or --flag: WHY.
ImportedArm ArmFromUrdf(const std::string& path, const ArmChoices& choices);

}  // namespace sidestep::import
