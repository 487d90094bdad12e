#include "sidestep/planner/straight_line_planner.h"

#include "sidestep/planner/first_guess.h"

namespace sidestep::planner {

PlanAnswer StraightLinePlanner::DoPlan(const PlanRequest& request, PlanJudge&) const {
  return {.trajectory = MakeDirectMotion(request, Timing::kWholeTime), .converged = true};
}

PlannerKind StraightLineKind() {
  return {"straight to the goal, whatever is in the way: what planning is worth",
          {},
          [](const robot::RobotModel& robot, const PlannerSettings& settings, const Parameters&) {
            return std::make_unique<StraightLinePlanner>(robot, settings);
          }};
}

}  // namespace sidestep::planner
