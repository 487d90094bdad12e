#pragma once

#include <ceres/iteration_callback.h>
#include <ceres/problem.h>

#include "sidestep/planner/trajectory_optimizer.h"

namespace sidestep::planner {

/// Ceres' Levenberg-Marquardt as all planners here run it: non-monotonic, because the gradient of a
/// trilinear field jumps at cell faces; sparse Cholesky by Eigen, which keeps system BLAS out; one
/// thread. Ends with the best so far where the budget is spent by the clock or by a stop.
/// @param may_end if given, looks at each iteration's states and says when they are good enough.
SolveOutcome SolveByLevenbergMarquardt(ceres::Problem& problem, int max_iterations,
                                       double function_tolerance, const PlanBudget& budget = {},
                                       ceres::IterationCallback* may_end = nullptr);

}  // namespace sidestep::planner
