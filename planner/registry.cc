#include "sidestep/planner/registry.h"

#include <ceres/version.h>

#include <stdexcept>

namespace sidestep::planner {

#define SIDESTEP_PLANNER(name, meaning, make, file) \
  std::unique_ptr<Planner> make(const robot::RobotModel&, const PlannerSettings&);
#include "sidestep/planner/planners.def"
#undef SIDESTEP_PLANNER

namespace {

struct Entry {
  const char* name;
  const char* meaning;
  std::unique_ptr<Planner> (*make)(const robot::RobotModel& robot, const PlannerSettings& settings);
};
constexpr Entry kPlanners[] = {
#define SIDESTEP_PLANNER(name, meaning, make, file) {name, meaning, &(make)},
#include "sidestep/planner/planners.def"
#undef SIDESTEP_PLANNER
};

const Entry& Find(const std::string& name) {
  std::string known;
  for (const Entry& entry : kPlanners) {
    if (name == entry.name) return entry;
    known += known.empty() ? entry.name : std::string(", ") + entry.name;
  }
  throw std::invalid_argument("unknown planner '" + name + "'; there are: " + known);
}

}  // namespace

std::vector<std::string> PlannerNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kPlanners) names.push_back(entry.name);
  return names;
}

std::string MeaningOfPlanner(const std::string& name) { return Find(name).meaning; }

std::unique_ptr<Planner> MakePlanner(const std::string& name, const robot::RobotModel& robot,
                                     const PlannerSettings& settings) {
  CheckPlannerSettings(settings);
  return Find(name).make(robot, settings);
}

std::string CeresVersion() { return CERES_VERSION_STRING; }

}  // namespace sidestep::planner
