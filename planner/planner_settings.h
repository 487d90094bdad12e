#pragma once

#include <limits>

#include "sidestep/planner/limit_use.h"

namespace sidestep::planner {

/// What is asked of every planner, whatever else can be set of it (planner/parameters.h).
struct PlannerSettings {
  double epsilon_m = 0.2;  ///< safety margin: how far from obstacles a motion is to keep
  bool velocity_limits = true;
  bool acceleration_limits = true;
  bool position_limits = true;
  /// Fractions of the robot's limits to plan within, (0, 1]. What the plan leaves of the velocity,
  /// corrections may use; what it leaves of the acceleration keeps a compliant arm on its plan, and
  /// libfranka's rate limits away.
  double velocity_scale = 0.95;
  double acceleration_scale = 0.5;
  /// How fast the tool may be [m/s] > 0, for example because a supervisor slows down what is
  /// faster. No cost knows it, but nobody asks for a motion in less time than the direct one takes
  /// so.
  double tool_speed_m_s = std::numeric_limits<double>::infinity();
};

/// @throws std::invalid_argument, naming the setting, for one out of range.
void CheckPlannerSettings(const PlannerSettings& settings);

/// The largest share that a motion uses of the limits that `settings` ask for: the scaled ones of
/// the kinds that are switched on.
double LargestShare(const LimitUse& use, const PlannerSettings& settings);

/// A share above this is worth a later arrival, or less clearance, for one that is not.
inline constexpr double kMuchTooFast = 1.05;

/// Whether a motion that uses so much of a robot's limits keeps those that `settings` ask for: the
/// scaled ones of the kinds that are switched on, but for a thousandth.
bool KeepsLimits(const LimitUse& use, const PlannerSettings& settings);

/// The same of the robot's own limits, unscaled and to the last bit.
bool KeepsWholeLimits(const LimitUse& use, const PlannerSettings& settings);

}  // namespace sidestep::planner
