#include "planner/registry.h"

#include <ceres/version.h>

#include <array>
#include <stdexcept>

#include "planner/gauss_newton_planner.h"
#include "planner/gp_planner.h"
#include "planner/straight_line_planner.h"

namespace sidestep {
namespace {

struct Entry {
  const char* name;
  std::unique_ptr<Planner> (*make)(const RobotModel& robot, const PlannerSettings& settings);
};

constexpr std::array kPlanners = {
    Entry{"gauss_newton",
          [](const RobotModel& robot, const PlannerSettings& settings) -> std::unique_ptr<Planner> {
            return std::make_unique<GaussNewtonPlanner>(robot, settings);
          }},
    Entry{"gpmp",
          [](const RobotModel& robot, const PlannerSettings& settings) -> std::unique_ptr<Planner> {
            return std::make_unique<GpPlanner>(robot, settings);
          }},
    Entry{"straight_line",
          [](const RobotModel& robot, const PlannerSettings&) -> std::unique_ptr<Planner> {
            return std::make_unique<StraightLinePlanner>(robot);
          }},
};

}  // namespace

std::vector<std::string> PlannerNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kPlanners) names.push_back(entry.name);
  return names;
}

std::unique_ptr<Planner> MakePlanner(const std::string& name, const RobotModel& robot,
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

}  // namespace sidestep
