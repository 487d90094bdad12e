#pragma once

#include "sidestep/planner/limit_use.h"

namespace sidestep::planner {

/// What scenario files set of a planner. Units as named; sources: the GPMP2 obstacle and GP costs.
struct PlannerSettings {
  double epsilon_m = 0.2;    ///< safety margin of the obstacle cost
  double sigma_obs = 0.05;   ///< of the obstacle cost
  int num_interpolated = 1;  ///< obstacle costs between support states (n_int)
  double qc = 1.0;           ///< power spectral density of the GP prior, per joint
  double sigma_goal = 1e-4;  ///< of the goal prior (position and velocity)
  bool velocity_limits = true;
  bool acceleration_limits = true;
  bool position_limits = true;
  /// Fractions of the robot's limits to plan within, (0, 1]. What the plan leaves of the velocity,
  /// corrections may use; what it leaves of the acceleration keeps a compliant arm on its plan, and
  /// libfranka's rate limits away.
  double velocity_scale = 0.95;
  double acceleration_scale = 0.5;
  int max_iterations = 50;  ///< of one solve
  /// Guesses over random configurations that a cold start tries when no other leads to a free
  /// plan.
  int num_detours = 4;
  double function_tolerance = 1e-4;
};

/// @throws std::invalid_argument, naming the setting, for one out of range.
void CheckPlannerSettings(const PlannerSettings& settings);

/// Whether a motion that uses so much of a robot's limits keeps those that `settings` ask for: the
/// scaled ones of the kinds that are switched on, but for a thousandth.
bool KeepsLimits(const LimitUse& use, const PlannerSettings& settings);

}  // namespace sidestep::planner
