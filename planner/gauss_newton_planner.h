#pragma once

#include "sidestep/planner/gp_settings.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"

namespace sidestep::planner {

/// `gauss_newton`: the solver of the published experiments (planner/gauss_newton.h), as a planner:
/// plain Gauss-Newton from the first guess, fixed states held by priors of sigma_goal, no limits,
/// no second try. A yardstick: what undamped steps find depends on how they end, and the limits of
/// the robot may be exceeded; the result says so.
class GaussNewtonPlanner final : public Planner {
 public:
  /// @throws std::invalid_argument for settings out of range.
  GaussNewtonPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
                     const GpSettings& gp = {});

  PlannerCapabilities capabilities() const override {
    return {.reaches_goal = true, .avoids_obstacles = true};
  }

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge& judge) const override;
  GpSettings gp_;
};

PlannerKind GaussNewtonKind();

}  // namespace sidestep::planner
