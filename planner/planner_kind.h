#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
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

/// The kind of a planner that is made of (robot, settings, a struct of parameters).
/// @param table is borrowed for good.
template <class Made, class Struct>
PlannerKind KindOf(std::string meaning, const ParameterTable<Struct>& table) {
  return {std::move(meaning), table.declared(),
          [&table](const robot::RobotModel& robot, const PlannerSettings& settings,
                   const Parameters& parameters) {
            return std::make_unique<Made>(robot, settings, table.Read(parameters));
          }};
}

}  // namespace sidestep::planner
