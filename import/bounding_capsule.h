#pragma once

#include <vector>

#include "sidestep/robot/arm_description.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::imports {

/// A small capsule around all solids of a link, in the link's frame: the smallest of those along
/// its principal axes and its frame's. `solids` must not be empty.
robot::CollisionCapsule CapsuleAround(const std::vector<robot::LinkSolid>& solids);

}  // namespace sidestep::imports
