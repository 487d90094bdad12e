#pragma once

#include "planner/planner_settings.h"
#include "scenarios/scenario.h"

namespace sidestep {

/// What a scenario says of its planner.
PlannerSettings MakePlannerSettings(const Scenario& scenario);

}  // namespace sidestep
