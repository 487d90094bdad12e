#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// Version of the solver library, e.g. "2.1.0".
std::string CeresVersion();

/// The names of all planners.
std::vector<std::string> PlannerNames();

/// What one does, in a line. @throws std::invalid_argument for an unknown name.
std::string MeaningOfPlanner(const std::string& name);

/// @throws std::invalid_argument for an unknown name or settings out of range.
std::unique_ptr<Planner> MakePlanner(const std::string& name, const robot::RobotModel& robot,
                                     const PlannerSettings& settings);

}  // namespace sidestep::planner
