#pragma once

#include <string>

#include "sidestep/import/arm_choices.h"
#include "sidestep/robot/robot_tree.h"

namespace sidestep::imports {

/// Reads a URDF with its meshes. A mesh becomes its convex hull, of at most `max_hull_vertices`
/// corners. Of links above `base`, if that is given, nothing but the name.
/// @throws InputError FILE:LINE: KEY: WHY.
robot::RobotTree ReadUrdfTree(const std::string& path, const ArmChoices& choices);

}  // namespace sidestep::imports
