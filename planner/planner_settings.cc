#include "sidestep/planner/planner_settings.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace sidestep::planner {
namespace {

void Require(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument("planner settings: " + what);
}

bool IsPositive(double value) { return std::isfinite(value) && value > 0; }

bool IsFraction(double value) { return value > 0 && value <= 1; }

constexpr double kLimitTolerance = 1e-3;  // what an optimum at a limit exceeds it by is rounding

}  // namespace

void CheckPlannerSettings(const PlannerSettings& settings) {
  Require(std::isfinite(settings.epsilon_m) && settings.epsilon_m >= 0, "epsilon_m must be >= 0");
  Require(IsPositive(settings.sigma_obs), "sigma_obs must be > 0");
  Require(settings.num_interpolated >= 0, "num_interpolated must be >= 0");
  Require(IsPositive(settings.qc), "qc must be > 0");
  Require(IsPositive(settings.sigma_goal), "sigma_goal must be > 0");
  Require(IsFraction(settings.velocity_scale), "velocity_scale must be in (0, 1]");
  Require(IsFraction(settings.acceleration_scale), "acceleration_scale must be in (0, 1]");
  Require(settings.max_iterations >= 1, "max_iterations must be >= 1");
  Require(settings.num_detours >= 0, "num_detours must be >= 0");
  Require(IsPositive(settings.function_tolerance), "function_tolerance must be > 0");
}

bool KeepsLimits(const LimitUse& use, const PlannerSettings& settings) {
  constexpr double kWhole = 1 + kLimitTolerance;
  return (!settings.position_limits || use.position <= kWhole) &&
         (!settings.velocity_limits || use.velocity <= kWhole * settings.velocity_scale) &&
         (!settings.acceleration_limits ||
          use.acceleration <= kWhole * settings.acceleration_scale);
}

}  // namespace sidestep::planner
