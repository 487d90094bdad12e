#pragma once

#include "sidestep/control/safety.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::sim {

/// How a scenario wants its robot supervised.
/// @throws InputError if it wants that, and the robot has no capsules.
control::SafetySettings SafetyOf(const scenarios::Scenario& scenario,
                                 const robot::RobotModel& robot);

}  // namespace sidestep::sim
