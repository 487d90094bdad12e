#include "sidestep/planner/registry.h"

#include <ceres/version.h>

#include <stdexcept>

namespace sidestep::planner {

#define SIDESTEP_PLANNER(name, make, file) \
  std::unique_ptr<Planner> make(const robot::RobotModel&, const PlannerSettings&);
#include "sidestep/planner/planners.def"
#undef SIDESTEP_PLANNER

namespace {

struct Entry {
  const char* name;
  std::unique_ptr<Planner> (*make)(const robot::RobotModel& robot, const PlannerSettings& settings);
};
constexpr Entry kPlanners[] = {
#define SIDESTEP_PLANNER(name, make, file) {name, &(make)},
#include "sidestep/planner/planners.def"
#undef SIDESTEP_PLANNER
};

}  // namespace

std::vector<std::string> PlannerNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kPlanners) names.push_back(entry.name);
  return names;
}

std::unique_ptr<Planner> MakePlanner(const std::string& name, const robot::RobotModel& robot,
                                     const PlannerSettings& settings) {
  CheckPlannerSettings(settings);
  std::string known;
  for (const Entry& entry : kPlanners) {
    if (name == entry.name) return entry.make(robot, settings);
    known += known.empty() ? entry.name : std::string(", ") + entry.name;
  }
  throw std::invalid_argument("unknown planner '" + name + "'; there are: " + known);
}

std::string CeresVersion() { return CERES_VERSION_STRING; }

}  // namespace sidestep::planner
