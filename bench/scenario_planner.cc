#include "sidestep/bench/scenario_planner.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/core/joined.h"
#include "sidestep/planner/direct_time.h"
#include "sidestep/planner/parameters.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/planner/registry.h"

namespace sidestep::bench {
namespace {

using planner::Parameter;

std::string KeyOf(const std::string& parameter) { return "planner." + parameter; }

const Parameter* Find(const std::vector<Parameter>& declared, const std::string& name) {
  const auto found = std::find_if(declared.begin(), declared.end(),
                                  [&](const Parameter& one) { return one.name == name; });
  return found == declared.end() ? nullptr : &*found;
}

bool IsSetApart(const scenarios::Scenario& scenario, const std::string& key) {
  const auto line = scenario.lines.find(key);
  return line != scenario.lines.end() && line->second == 0;
}

bool AnyPlannerHas(const std::string& parameter) {
  const std::vector<std::string> names = planner::PlannerNames();
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return Find(planner::KindOfPlanner(name).parameters, parameter) != nullptr;
  });
}

std::vector<std::string> KnownKeys(const std::vector<Parameter>& declared) {
  std::vector<std::string> keys = scenarios::SharedPlannerKeys();
  for (const Parameter& parameter : declared) keys.push_back(parameter.name);
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace

void ResolvePlanner(scenarios::Scenario& scenario) {
  const std::vector<std::string> names = planner::PlannerNames();
  if (std::find(names.begin(), names.end(), scenario.planner) == names.end()) {
    throw WrongValue(scenario, KeyOf("name"),
                     "must be one of " + Joined(names) + ", is '" + scenario.planner + "'");
  }
  const std::vector<Parameter> declared = planner::KindOfPlanner(scenario.planner).parameters;
  std::map<std::string, std::string> resolved;
  for (const Parameter& parameter : declared) {
    resolved[parameter.name] = planner::ToText(parameter.default_value);
  }
  const bool is_another = IsSetApart(scenario, KeyOf("name"));
  for (const auto& [name, text] : scenario.planner_parameters) {
    const Parameter* const parameter = Find(declared, name);
    if (parameter == nullptr) {
      if (is_another && !IsSetApart(scenario, KeyOf(name)) && AnyPlannerHas(name)) continue;
      throw WrongValue(scenario, KeyOf(name),
                       "is not a known key (known here: " + Joined(KnownKeys(declared)) + ")");
    }
    try {
      resolved[name] = planner::ToText(planner::ParseValue(*parameter, text));
    } catch (const std::invalid_argument& error) {
      throw WrongValue(scenario, KeyOf(name), error.what());
    }
  }
  scenario.planner_parameters = resolved;
}

planner::PlannerSettings SettingsOf(const scenarios::Scenario& scenario) {
  planner::PlannerSettings settings;
  settings.epsilon_m = scenario.epsilon_m;
  settings.velocity_scale = scenario.velocity_scale;
  settings.acceleration_scale = scenario.acceleration_scale;
  settings.position_limits = scenario.position_limits;
  settings.velocity_limits = scenario.velocity_limits;
  settings.acceleration_limits = scenario.acceleration_limits;
  // The supervisor slows down what comes near the speed at which it stops.
  constexpr double kToolShare = 0.9;
  if (scenario.safety.profile == scenarios::SafetyProfile::kLab) {
    settings.tool_speed_m_s = kToolShare * scenario.safety.tool_speed_m_s;
  }
  return settings;
}

planner::Parameters ParametersOf(const scenarios::Scenario& scenario) {
  planner::Parameters parameters;
  const std::vector<Parameter> declared = planner::KindOfPlanner(scenario.planner).parameters;
  for (const auto& [name, text] : scenario.planner_parameters) {
    const Parameter* const parameter = Find(declared, name);
    parameters[name] = parameter == nullptr ? planner::ParameterValue(text)
                                            : planner::ParseValue(*parameter, text);
  }
  return parameters;
}

std::unique_ptr<planner::Planner> MakePlanner(const scenarios::Scenario& scenario,
                                              const robot::RobotModel& robot) {
  return planner::MakePlanner(scenario.planner, robot, SettingsOf(scenario),
                              ParametersOf(scenario));
}

planner::PlanRequest RequestOf(const scenarios::Scenario& scenario, double horizon_s) {
  planner::PlanRequest request;
  request.step_s = scenario.step_s;
  request.num_states = static_cast<int>(std::lround(horizon_s / scenario.step_s)) + 1;
  request.q_start = scenario.q_start;
  request.v_start = Eigen::VectorXd::Zero(scenario.q_start.size());
  request.q_goal = scenario.q_goal;
  return request;
}

double HorizonOf(const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  constexpr double kRounding = 1e-9;
  const auto steps = [&](double time_s) { return std::ceil(time_s / scenario.step_s - kRounding); };
  const double direct_s =
      planner::DirectTime_s(robot, SettingsOf(scenario), scenario.q_start, scenario.q_goal);
  const double needed = steps(direct_s) + steps(scenario.longest_latency_s());
  return std::max(scenario.horizon_s, needed * scenario.step_s);
}

}  // namespace sidestep::bench
