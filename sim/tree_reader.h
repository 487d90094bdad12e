#pragma once

#include <string>

#include "sidestep/robot/robot_tree.h"

namespace sidestep::sim {

/// Reads an arm's MJCF as it is found elsewhere (MuJoCo Menagerie): with classes of defaults, mesh
/// files, any actuators. Each body becomes a link, whose frame is the body's moved to its joint's
/// anchor, turned or slid back by the joint's reference. Left out, and told: physics options,
/// keyframes, sensors, ties other than of one joint to another.
///
/// Hulls of meshes hold their vertices alone, all of the mesh's: they are yet to be made.
///
/// @param visuals_as_collisions takes the geoms that touch nothing, of links that have no others.
/// @throws InputError at its line, for what this MuJoCo does not know, and what an arm cannot be.
robot::RobotTree ReadMjcfTree(const std::string& path, bool visuals_as_collisions);

}  // namespace sidestep::sim
