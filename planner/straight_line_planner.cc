#include "planner/straight_line_planner.h"

#include "planner/first_guess.h"

namespace sidestep {

PlanResult StraightLinePlanner::DoPlan(const PlanRequest& request) const {
  return MakeResult(request, MakeDirectMotion(request, Timing::kWholeTime), /*converged=*/true);
}

}  // namespace sidestep
