#pragma once

#include <mujoco/mujoco.h>

namespace sidestep::sim {

/// Puts each joint that an `equality` ties to another where that one leads it, by the positions in
/// `data`: what a simulation only keeps so is so from the start. Speeds stay.
void FollowLeaders(const mjModel& model, mjData* data);

}  // namespace sidestep::sim
