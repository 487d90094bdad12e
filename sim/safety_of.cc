#include "sidestep/sim/safety_of.h"

namespace sidestep::sim {

control::SafetySettings SafetyOf(const scenarios::Scenario& scenario,
                                 const robot::RobotModel& robot) {
  control::SafetySettings safety;
  switch (scenario.safety.profile) {
    case scenarios::SafetyProfile::kOff:
      return safety;
    case scenarios::SafetyProfile::kObserve:
      safety.profile = control::SafetyProfile::kObserve;
      break;
    case scenarios::SafetyProfile::kLab:
      safety.profile = control::SafetyProfile::kLab;
      break;
  }
  if (robot.capsules().empty()) {
    throw scenarios::WrongValue(scenario, "safety.profile",
                                robot.name() + " has no capsules to be supervised by");
  }
  safety.obstacle_speed_m_s = scenario.safety.obstacle_speed_m_s;
  safety.obstacle_acceleration_m_s2 = scenario.safety.obstacle_acceleration_m_s2;
  safety.tool_speed_m_s = scenario.safety.tool_speed_m_s;
  safety.floor_m = scenario.floor_m;
  return safety;
}

}  // namespace sidestep::sim
