#include "sidestep/planner/planner_settings.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace sidestep::planner {
namespace {

void RequireOfSettings(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument("planner settings: " + what);
}

bool IsFraction(double value) { return value > 0 && value <= 1; }

constexpr double kLimitTolerance = 1e-3;  // what an optimum at a limit exceeds it by is rounding

}  // namespace

void CheckPlannerSettings(const PlannerSettings& settings) {
  RequireOfSettings(std::isfinite(settings.epsilon_m) && settings.epsilon_m >= 0,
                    "epsilon_m must be >= 0");
  RequireOfSettings(IsFraction(settings.velocity_scale), "velocity_scale must be in (0, 1]");
  RequireOfSettings(IsFraction(settings.acceleration_scale),
                    "acceleration_scale must be in (0, 1]");
  RequireOfSettings(settings.tool_speed_m_s > 0, "tool_speed_m_s must be > 0");
}

double LargestShare(const LimitUse& use, const PlannerSettings& settings) {
  double share = 0;
  if (settings.position_limits) share = std::max(share, use.position);
  if (settings.velocity_limits) share = std::max(share, use.velocity / settings.velocity_scale);
  if (settings.acceleration_limits) {
    share = std::max(share, use.acceleration / settings.acceleration_scale);
  }
  return share;
}

bool KeepsLimits(const LimitUse& use, const PlannerSettings& settings) {
  return LargestShare(use, settings) <= 1 + kLimitTolerance;
}

bool KeepsWholeLimits(const LimitUse& use, const PlannerSettings& settings) {
  return (!settings.position_limits || use.position <= 1) &&
         (!settings.velocity_limits || use.velocity <= 1) &&
         (!settings.acceleration_limits || use.acceleration <= 1);
}

}  // namespace sidestep::planner
