#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bench/metrics/registry.h"
#include "cli/command.h"
#include "cli/data_paths.h"
#include "planner/registry.h"
#include "robot/robot_model.h"
#include "scenarios/scenario.h"
#include "sdf/prediction/registry.h"
#include "sdf/world_model.h"
#include "sim/sensors.h"

namespace sidestep {
namespace {

void PrintWords(const char* title, const std::vector<std::string>& words) {
  std::printf("%s\n", title);
  for (const std::string& word : words) std::printf("  %s\n", word.c_str());
}

int List() {
  const DataPaths paths = FindDataPaths();
  std::printf("scenarios\n");
  for (const std::string& name : ScenarioNames(paths.scenarios)) {
    const Scenario scenario = LoadScenario(paths.scenarios + "/" + name + ".yaml");
    std::printf("  %-24s %s\n", name.c_str(), scenario.description.c_str());
  }
  PrintWords("robots", RobotModel::ListNames(paths.models));
  std::printf("knowledge\n");
  for (const Knowledge knowledge : kAllKnowledge)
    std::printf("  %s\n", ToString(knowledge).c_str());
  PrintWords("planners", PlannerNames());
  PrintWords("predictors", PredictorNames());
  PrintWords("sensors", SensorNames());
  std::printf("metrics\n");
  for (const Metric& metric : Metrics()) {
    std::printf("  %-24s %s [%s]\n", metric.name, metric.meaning, metric.unit);
  }
  return 0;
}

}  // namespace

void AddListCommand(CommandLine& line) {
  CLI::App* const list =
      line.app.add_subcommand("list",
                              "List what can be named: scenarios, robots, knowledge, planners, "
                              "predictors, sensors, metrics");
  list->callback([&line] { line.exit_code = List(); });
}

}  // namespace sidestep
