#pragma once

#include <vector>

#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// Comes to rest from (q, v) of `from`, each joint at a constant deceleration, and stays there
/// until (num_states - 1) step_s or the end of the stop, whichever is later: a stop is never cut
/// short.
///
/// All joints take one time, so that the arm keeps the direction it moves in: the slowest joint's,
/// rounded up to whole steps, or less if a joint would else leave its position limits. Where no one
/// time keeps every joint within its limits of acceleration and position, each takes its own. A
/// position limit that a joint would leave at its full deceleration is broken.
///
/// Decelerates by 0.9 of the limits, by more only where a position limit asks for it, and never
/// within less than 0.01 s: what follows the motion lags its corners, and catches up with the rest.
///
/// Support states are those of the grid and the moments at which joints come to rest.
/// @param step_s, num_states the grid: num_states >= 2.
Trajectory MakeBraking(const std::vector<robot::JointLimits>& limits, const TrajectoryPoint& from,
                       double step_s, int num_states);

}  // namespace sidestep::planner
