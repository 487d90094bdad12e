#pragma once

#include "sidestep/core/trajectory.h"
#include "sidestep/planner/planner.h"

namespace sidestep::planner {

struct SolveOutcome {
  int iterations = 0;
  bool converged = false;
};

/// One request, ready to be optimised from any number of guesses: what a planner's policy (which
/// guesses, how long, which answer is best) needs of a solver. One thread at a time.
class TrajectoryOptimizer {
 public:
  virtual ~TrajectoryOptimizer() = default;

  /// Goes to `guess`, which holds the request's fixed states and stands on its grid, and leaves
  /// limits out of the objective until they are added.
  virtual void Restart(const Trajectory& guess) = 0;
  /// Adds what limits cost, with weights so many times the usual; once more, for stiffer ones.
  virtual void AddLimits(double stiffness) = 0;
  /// Improves the present states until an iteration changes the cost by no more than
  /// `function_tolerance` of it, or `max_iterations` are over.
  virtual SolveOutcome Solve(int max_iterations, double function_tolerance) = 0;

  virtual Trajectory GetTrajectory() const = 0;
  /// The objective at the present states, limits included once they are added.
  virtual PlanCost ComputeCost() = 0;
};

}  // namespace sidestep::planner
