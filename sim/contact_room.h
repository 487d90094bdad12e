#pragma once

#include "sidestep/sim/mujoco_model.h"

namespace sidestep::sim {

// MuJoCo keeps contacts, and the constraints they make, in buffers of a fixed size, and drops what
// does not fit. How many there will be depends on how deep a robot lies in how many things; room
// for all that a scene could have at worst would be gigabytes, since it grows with the square of
// the constraints. So there is room for what is usual, and more is made when it turns out too
// small.

/// Whether contacts or constraints were dropped since `data` was made.
bool LacksContactRoom(const mjData& data);

/// Doubles the room: `data` becomes a state of its own at the same time, positions, velocities,
/// controls, forces and motor torques. What depends on them is to be computed anew (mj_step1).
/// @return false, and nothing is changed, where the room would take more than half a gigabyte.
bool DoubleContactRoom(mjModel* model, MujocoDataPtr* data);

}  // namespace sidestep::sim
