#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/planner/parameters.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// What there is to know of a planner before there is one.
struct PlannerKind {
  std::string meaning;  ///< what it does, in a line
  std::vector<Parameter> parameters;
  /// `parameters` holds all that are declared, each as it may be.
  /// @throws std::invalid_argument for settings out of range.
  std::function<std::unique_ptr<Planner>(const robot::RobotModel& robot,
                                         const PlannerSettings& settings,
                                         const Parameters& parameters)>
      make;
};

}  // namespace sidestep::planner
