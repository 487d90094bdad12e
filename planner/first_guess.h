#pragma once

#include "sidestep/core/random.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/planner.h"

namespace sidestep::planner {

/// When a direct motion uses the time it has. Nearly every plan that a moving obstacle spoils is
/// spoilt by its timing, passing before the obstacle instead of behind it or the reverse, so other
/// timings are the seeds worth trying.
enum class Timing {
  kWholeTime,    ///< leaves at once, arrives at the end
  kLeaveLate,    ///< brakes or waits for the first 40 %
  kArriveEarly,  ///< arrives after 60 %
};

/// The request's fixed states, then joint by joint the cubic to the goal, which it reaches at rest:
/// with kWholeTime the smoothest motion in the sense of the GP cost, and a straight line when it
/// begins at rest. Ignores obstacles and limits.
Trajectory MakeDirectMotion(const PlanRequest& request, Timing timing);

/// The request's fixed states, then to the goal over a random configuration off the direct line,
/// passed after 20 to 80 % of the free time: a way around what no other timing avoids. Ignores
/// obstacles and limits.
///
/// @param scale shape n: what one rad is for each joint (robot/tolerance_scale.h). The standard
/// deviation of a joint from the line is 0.7 of it.
Trajectory MakeDetour(const PlanRequest& request, const Eigen::VectorXd& scale,
                      RandomStream& random);

/// The request's fixed states, then what `plan` does at their times: an answer to another request
/// as a guess for this one.
Trajectory MakeContinuation(const PlanRequest& request, const TimedPlan& plan);

/// The request's `initial`, its state 0 replaced by (q_start, v_start). There must be one.
Trajectory MakeWarmStart(const PlanRequest& request);

}  // namespace sidestep::planner
