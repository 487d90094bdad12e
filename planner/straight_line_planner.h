#pragma once

#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"

namespace sidestep::planner {

/// `straight_line`: the direct motion to the goal with a smooth timing, whatever is in its way. The
/// yardstick for planners that look.
class StraightLinePlanner final : public Planner {
 public:
  StraightLinePlanner(const robot::RobotModel& robot, const PlannerSettings& settings)
      : Planner(robot, settings) {}

  PlannerCapabilities capabilities() const override { return {.reaches_goal = true}; }

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge& judge) const override;
};

PlannerKind StraightLineKind();

}  // namespace sidestep::planner
