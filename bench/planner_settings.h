#pragma once

#include "sidestep/planner/planner_settings.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// What a scenario says of its planner.
planner::PlannerSettings MakePlannerSettings(const scenarios::Scenario& scenario);

}  // namespace sidestep::bench
