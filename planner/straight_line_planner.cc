#include "sidestep/planner/straight_line_planner.h"

#include "sidestep/planner/first_guess.h"

namespace sidestep::planner {

PlanAnswer StraightLinePlanner::DoPlan(const PlanRequest& request, PlanJudge&) const {
  return {.trajectory = MakeDirectMotion(request, Timing::kWholeTime), .converged = true};
}

std::unique_ptr<Planner> MakeStraightLinePlanner(const robot::RobotModel& robot,
                                                 const PlannerSettings& settings) {
  return std::make_unique<StraightLinePlanner>(robot, settings);
}

}  // namespace sidestep::planner
