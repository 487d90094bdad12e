#pragma once

#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Looks up the scenario's start and goal in the robot's configurations and judges them: known, of
/// the right length, within the joint limits, and clear of the floor, of every static obstacle and
/// of the moving obstacles as they stand at t = 0 (start only). Mount spheres are not judged
/// against what the robot stands on: the mount or, without one, the floor. Clearance is exact:
/// spheres against the true shapes. The direct motion between them, within the limits that are
/// asked for, must fit a horizon (scenarios/horizon_bounds.h).
/// @throws InputError naming the scenario's file, line and key.
void ResolveTask(scenarios::Scenario& scenario, const robot::RobotModel& robot);

}  // namespace sidestep::bench
