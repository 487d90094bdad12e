#pragma once

#include <string>
#include <vector>

#include "sidestep/import/arm_choices.h"
#include "sidestep/robot/arm_description.h"
#include "sidestep/robot/robot_tree.h"

namespace sidestep::imports {

/// An arm, and what a person should know of how it came about.
struct ImportedArm {
  robot::ArmDescription arm;
  std::vector<std::string> notes;
};

/// Makes an arm of a tree: everything from the base link on. The joints from base to tip move, with
/// those that mimic one of them; all others are held at 0, or where `fix` says.
/// Base: the root. Tip: the one leaf that the most joints lead to.
/// @throws InputError FILE:LINE: KEY: WHY, or --flag: WHY.
ImportedArm ArmOfTree(const robot::RobotTree& tree, const ArmChoices& choices);

}  // namespace sidestep::imports
