#include "sidestep/bench/planner_settings.h"

namespace sidestep::bench {

planner::PlannerSettings MakePlannerSettings(const scenarios::Scenario& scenario) {
  planner::PlannerSettings settings;
  settings.epsilon_m = scenario.epsilon_m;
  settings.sigma_obs = scenario.sigma_obs;
  settings.num_interpolated = scenario.num_interpolated;
  settings.qc = scenario.qc;
  settings.velocity_scale = scenario.velocity_scale;
  settings.acceleration_scale = scenario.acceleration_scale;
  settings.max_iterations = scenario.max_iterations;
  settings.position_limits = scenario.position_limits;
  settings.velocity_limits = scenario.velocity_limits;
  settings.acceleration_limits = scenario.acceleration_limits;
  return settings;
}

}  // namespace sidestep::bench
