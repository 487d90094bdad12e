#pragma once

#include <memory>

#include "sidestep/planner/parameters.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Judges the scenario's planner and what is set of it, and fills in the defaults of what is not.
/// What the file sets of its own planner is left out where a person has chosen another planner
/// instead, which does not have it.
/// @throws InputError naming the scenario's file, line and key.
void ResolvePlanner(scenarios::Scenario& scenario);

/// What a scenario asks of its planner, and sets of it.
planner::PlannerSettings SettingsOf(const scenarios::Scenario& scenario);
/// @throws std::invalid_argument for an unknown planner or a text that is no value.
planner::Parameters ParametersOf(const scenarios::Scenario& scenario);

/// The planner that a scenario asks for.
/// @throws std::invalid_argument for an unknown planner, or one of which this cannot be set.
std::unique_ptr<planner::Planner> MakePlanner(const scenarios::Scenario& scenario,
                                              const robot::RobotModel& robot);

/// From start to goal of the scenario, at rest in both, over a horizon; without a field.
planner::PlanRequest RequestOf(const scenarios::Scenario& scenario, double horizon_s);

/// How far ahead plans reach [s]: the scenario's horizon or, where its limits do not let the direct
/// motion from start to goal be over by then, as many steps as that takes.
double HorizonOf(const scenarios::Scenario& scenario, const robot::RobotModel& robot);

}  // namespace sidestep::bench
