#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sidestep/planner/parameters.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// Version of the solver library, e.g. "2.1.0".
std::string CeresVersion();

/// The names of all planners.
std::vector<std::string> PlannerNames();

/// @throws std::invalid_argument for an unknown name.
PlannerKind KindOfPlanner(const std::string& name);
std::string MeaningOfPlanner(const std::string& name);

/// @param parameters those that are not to have their defaults.
/// @throws std::invalid_argument for an unknown name, for settings or parameters out of range, and
///   for a parameter that this planner does not have.
std::unique_ptr<Planner> MakePlanner(const std::string& name, const robot::RobotModel& robot,
                                     const PlannerSettings& settings,
                                     const Parameters& parameters = {});

/// The same with what it has of `parameters`: for problems that are put to planners of all kinds.
std::unique_ptr<Planner> MakePlannerLeavingOut(const std::string& name,
                                               const robot::RobotModel& robot,
                                               const PlannerSettings& settings,
                                               Parameters parameters);

}  // namespace sidestep::planner
