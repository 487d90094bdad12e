#pragma once

#include <map>
#include <string>
#include <vector>

#include "sidestep/import/arm_choices.h"
#include "sidestep/robot/robot_tree.h"

namespace sidestep::imports {

/// How one joint of a tree moves in the arm that is made of it.
struct JointRole {
  enum class Kind { kMoves, kMimics, kHeld };
  Kind kind = Kind::kHeld;
  double position = 0;  ///< of one that is held
  std::string leader;   ///< of one that mimics: a joint that moves
  double multiplier = 1, offset = 0;
};

/// Which part of a tree becomes the arm, and what moves in it.
struct JointChoice {
  std::string base, tip;
  std::vector<std::string> joints;  ///< below the base, parents and leaders before the others
  std::map<std::string, JointRole> roles;
  std::vector<std::string> other_leaves;
};

/// @throws InputError.
JointChoice ChooseJoints(const robot::RobotTree& tree, const ArmChoices& choices);

}  // namespace sidestep::imports
