#pragma once

#include <memory>

#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_settings.h"

namespace sidestep::planner {

/// `gauss_newton`: the solver of the published experiments (planner/gauss_newton.h), as a planner:
/// plain Gauss-Newton from the first guess, fixed states held by priors of sigma_goal, no limits,
/// no second try. A yardstick: what undamped steps find depends on how they end, and the limits of
/// the robot may be exceeded; the result says so. Settings: max_iterations and function_tolerance
/// bound the solve; the limits only judge it.
class GaussNewtonPlanner final : public Planner {
 public:
  /// @throws std::invalid_argument for settings out of range.
  GaussNewtonPlanner(const robot::RobotModel& robot, const PlannerSettings& settings);

  PlannerCapabilities capabilities() const override {
    return {.reaches_goal = true, .avoids_obstacles = true};
  }

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge& judge) const override;
};

std::unique_ptr<Planner> MakeGaussNewtonPlanner(const robot::RobotModel& robot,
                                                const PlannerSettings& settings);

}  // namespace sidestep::planner
