#pragma once

#include "sidestep/planner/parameters.h"

namespace sidestep::planner {

/// What can be set of the planners that optimise a Gaussian-process trajectory. Sources: the GPMP2
/// obstacle and GP costs (Mukadam et al., IJRR 2018).
struct GpSettings {
  double sigma_obs = 0.05;   ///< of the obstacle cost [m]
  int num_interpolated = 1;  ///< obstacle costs between support states (n_int)
  double qc = 1.0;           ///< power spectral density of the GP prior, per joint
  double sigma_goal = 1e-4;  ///< of the goal prior (position and velocity)
  int max_iterations = 50;   ///< of one solve
  /// Guesses over random configurations that a cold start tries when no other leads to a free
  /// plan.
  int num_detours = 4;
  double function_tolerance = 1e-4;
};

/// All of them, and those that have a meaning where a problem is solved once, from one guess.
const ParameterTable<GpSettings>& GpParameters();
const ParameterTable<GpSettings>& SingleSolveParameters();

}  // namespace sidestep::planner
