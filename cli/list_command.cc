#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/core/input_error.h"
#include "sidestep/planner/registry.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/world_model.h"
#include "sidestep/sim/sensors.h"

namespace sidestep::cli {
namespace {

// Those that have a robot, or those that have none.
std::vector<std::string> NamesOfScenarios(const DataPaths& paths, bool with_robot) {
  std::vector<std::string> names;
  for (const std::string& name : scenarios::ScenarioNames(paths.scenarios)) {
    const scenarios::Scenario scenario =
        scenarios::LoadScenario(paths.scenarios + "/" + name + ".yaml");
    if (scenario.robot.empty() != with_robot) names.push_back(name);
  }
  return names;
}

struct Kind {
  const char* title;
  std::vector<std::string> (*names)(const DataPaths&);
};

std::vector<std::string> KnowledgeNames(const DataPaths&) {
  std::vector<std::string> names;
  for (const sdf::Knowledge knowledge : sdf::kAllKnowledge) names.push_back(ToString(knowledge));
  return names;
}

const Kind kKinds[] = {
    {"scenarios", [](const DataPaths& paths) { return NamesOfScenarios(paths, true); }},
    {"field_scenes", [](const DataPaths& paths) { return NamesOfScenarios(paths, false); }},
    {"robots", [](const DataPaths& paths) { return robot::RobotModel::ListNames(paths.models); }},
    {"knowledge", &KnowledgeNames},
    {"planners", [](const DataPaths&) { return planner::PlannerNames(); }},
    {"predictors", [](const DataPaths&) { return sdf::PredictorNames(); }},
    {"sensors", [](const DataPaths&) { return sim::SensorNames(); }},
    {"metrics",
     [](const DataPaths&) {
       std::vector<std::string> names;
       for (const bench::Metric& metric : bench::Metrics()) names.emplace_back(metric.name);
       return names;
     }},
};

// A line for each choice that a scenario leaves open.
std::string ChoicesOf(const std::string& scenario_file) {
  std::string lines;
  for (const auto& [choice, options] : scenarios::ScenarioChoices(scenario_file)) {
    std::string list;
    for (const std::string& option : options) list += (list.empty() ? "" : "|") + option;
    lines += "\n    --set " + choice + "=" + list;
  }
  return lines;
}

// Every name with its kind; scenarios and metrics with what they are.
int ListAll() {
  const DataPaths paths = FindDataPaths();
  std::map<std::string, std::string> notes;
  for (const std::string& name : scenarios::ScenarioNames(paths.scenarios)) {
    const std::string file = paths.scenarios + "/" + name + ".yaml";
    notes[name] = scenarios::LoadScenario(file).description + ChoicesOf(file);
  }
  for (const bench::Metric& metric : bench::Metrics()) {
    notes[metric.name] = metric.meaning + std::string(" [") + metric.unit + "]";
  }
  for (const Kind& kind : kKinds) {
    Print("{}\n", kind.title);
    for (const std::string& name : kind.names(paths)) {
      const auto note = notes.find(name);
      if (note == notes.end()) {
        Print("  {}\n", name);
      } else {
        Print("  {:<24} {}\n", name, note->second);
      }
    }
  }
  return 0;
}

int ListNames(const std::string& kind_name) {
  std::string known;
  for (const Kind& kind : kKinds) {
    known += (known.empty() ? "" : ", ") + std::string(kind.title);
    if (kind_name != kind.title) continue;
    for (const std::string& name : kind.names(FindDataPaths())) Print("{}\n", name);
    return 0;
  }
  throw InputError("KIND", "must be one of " + known + ", is '" + kind_name + "'");
}

}  // namespace

void AddListCommand(CommandLine& line) {
  auto kind = std::make_shared<std::string>();
  CLI::App* const list = line.app.add_subcommand(
      "list",
      "List what can be named: scenarios, field scenes, robots, knowledge, planners, "
      "predictors, sensors, metrics");
  list->add_option("KIND", *kind, "Only the names of this kind, one a line, for scripts");
  list->callback([&line, kind] { line.exit_code = kind->empty() ? ListAll() : ListNames(*kind); });
}

}  // namespace sidestep::cli
