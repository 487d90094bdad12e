#pragma once

#include <Eigen/Core>

#include "sidestep/core/random.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/plan_request.h"

namespace sidestep::planner {

/// The guesses of a request in the order in which they are worth trying: the plan that runs, if
/// there is one, then direct motions by their timing; without a plan that runs, detours after them.
/// A guess is made when it is asked for. Detours are other ones for another time, so that who waits
/// without a way out tries more and more of them.
class Seeds {
 public:
  /// Borrows the request.
  /// @param scale of detours, as MakeDetour wants it.
  Seeds(const PlanRequest& request, int num_detours, Eigen::VectorXd scale);

  int count() const;
  /// Something that is tried only where nothing else is free.
  bool IsDetour(int seed) const { return seed >= num_direct_; }
  /// @param seed from 0 to count() - 1.
  Trajectory Make(int seed);

 private:
  const PlanRequest& request_;
  int num_detours_, num_direct_;
  Eigen::VectorXd scale_;
  RandomStream random_;
};

}  // namespace sidestep::planner
