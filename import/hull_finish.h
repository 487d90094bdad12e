#pragma once

#include "sidestep/import/arm_choices.h"
#include "sidestep/robot/robot_tree.h"

namespace sidestep::imports {

/// A convex hull with at most `max_vertices` of its corners, each to the micrometre as it is
/// written; none if they span no solid.
/// @param note gets what a person should know of it, or nothing: "has a hull of ...".
std::optional<robot::HullSolid> FinishedHull(const robot::HullSolid& whole, int max_vertices,
                                             std::string* note);

/// Makes the hulls of a tree whose meshes hold vertices alone. @throws InputError.
void FinishHulls(const ArmChoices& choices, robot::RobotTree* tree);

}  // namespace sidestep::imports
