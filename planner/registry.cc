#include "sidestep/planner/registry.h"

#include <ceres/version.h>

#include <stdexcept>

namespace sidestep::planner {

#define SIDESTEP_PLANNER(name, kind, file) PlannerKind kind();
#include "sidestep/planner/planners.def"
#undef SIDESTEP_PLANNER

namespace {

struct Entry {
  const char* name;
  PlannerKind (*kind)();
};
constexpr Entry kPlanners[] = {
#define SIDESTEP_PLANNER(name, kind, file) {name, &(kind)},
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

PlannerKind KindOfPlanner(const std::string& name) { return Find(name).kind(); }

std::string MeaningOfPlanner(const std::string& name) { return KindOfPlanner(name).meaning; }

std::unique_ptr<Planner> MakePlanner(const std::string& name, const robot::RobotModel& robot,
                                     const PlannerSettings& settings,
                                     const Parameters& parameters) {
  const PlannerKind kind = KindOfPlanner(name);
  return kind.make(robot, settings, Complete(kind.parameters, parameters));
}

std::unique_ptr<Planner> MakePlannerLeavingOut(const std::string& name,
                                               const robot::RobotModel& robot,
                                               const PlannerSettings& settings,
                                               Parameters parameters) {
  const Parameters all = Complete(KindOfPlanner(name).parameters, {});
  std::erase_if(parameters, [&](const auto& one) { return all.count(one.first) == 0; });
  return MakePlanner(name, robot, settings, parameters);
}

std::string CeresVersion() { return CERES_VERSION_STRING; }

}  // namespace sidestep::planner
