#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/sensors.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/planner/parameters.h"
#include "sidestep/planner/registry.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/robot/variant_names.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::cli {
namespace {

struct Item {
  std::string name;
  std::string note = "";     // further lines are indented already
  std::string details = "";  // likewise; for who asks for its kind
};

struct Kind {
  const char* title;
  std::vector<Item> items;
};

// A line for each choice that a scenario leaves open.
std::string ChoicesOf(const std::string& scenario_file) {
  std::string lines;
  for (const auto& [choice, options] : scenarios::ScenarioChoices(scenario_file)) {
    lines += "\n    --set " + choice + "=" + Joined(options, "|");
  }
  return lines;
}

// A line for each parameter that a planner declares.
std::string ParametersOf(const std::string& planner) {
  std::string lines;
  for (const planner::Parameter& one : planner::KindOfPlanner(planner).parameters) {
    const std::string bounds = planner::BoundsOf(one);
    lines += fmt::format("\n    --set planner.{}={}{}  {}{}: {}", one.name,
                         planner::ToText(one.default_value),
                         one.unit.empty() ? "" : " [" + one.unit + "]", planner::TypeOf(one),
                         bounds.empty() ? "" : " " + bounds, one.meaning);
  }
  return lines;
}

// Everything that can be named, but for scenario files that are wrong: why is in `faults`.
class Catalogue {
 public:
  explicit Catalogue(const DataPaths& paths) {
    AddScenarios(paths.scenarios);
    AddSweeps(paths.scenarios + "/sweeps");
    AddRobots(paths.all_models());
    Kind& knowledge = kinds_.emplace_back(Kind{"knowledge", {}});
    for (const sdf::Knowledge one : sdf::kAllKnowledge) {
      knowledge.items.push_back({ToString(one)});
    }
    kinds_.push_back({"planners", Items(planner::PlannerNames(), &planner::MeaningOfPlanner)});
    for (Item& planner : kinds_.back().items) planner.details = ParametersOf(planner.name);
    kinds_.push_back({"predictors", Items(sdf::PredictorNames(), &sdf::MeaningOfPredictor)});
    kinds_.push_back({"sensors", Items(SensorNames(), &MeaningOfSensor)});
    Kind& metrics = kinds_.emplace_back(Kind{"metrics", {}});
    for (const bench::Metric& metric : bench::Metrics()) {
      metrics.items.push_back(
          {metric.name, metric.meaning + std::string(" [") + metric.unit + "]"});
    }
  }

  const std::vector<Kind>& kinds() const { return kinds_; }
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  static std::vector<Item> Items(const std::vector<std::string>& names,
                                 std::string (*meaning)(const std::string&) = nullptr) {
    std::vector<Item> items;
    for (const std::string& name : names) {
      items.push_back({name, meaning == nullptr ? "" : meaning(name)});
    }
    return items;
  }

  void AddRobots(const ModelFolders& models) {
    Kind robots{"robots", {}};
    for (const std::string& name : robot::RobotModel::ListNames(models)) {
      const std::string folder = models.Find(name).value_or("");
      robots.items.push_back({name, folder});
      for (const std::string& variant : robot::VariantNames(folder)) {
        robots.items.push_back({variant, "with other spheres"});
      }
    }
    kinds_.push_back(std::move(robots));
  }

  void AddScenarios(const std::string& folder) {
    Kind with_robot{"scenarios", {}}, without{"field_scenes", {}};
    for (const std::string& name : scenarios::ScenarioNames(folder)) {
      const std::string file = folder + "/" + name + ".yaml";
      try {
        const scenarios::Scenario scenario = scenarios::LoadScenario(file);
        Kind& kind = scenario.robot.empty() ? without : with_robot;
        kind.items.push_back({name, OneLine(scenario.description) + ChoicesOf(file)});
      } catch (const InputError& error) {
        faults_.push_back(error.what());
      }
    }
    kinds_.push_back(std::move(with_robot));
    kinds_.push_back(std::move(without));
  }

  void AddSweeps(const std::string& folder) {
    Kind sweeps{"sweeps", {}};
    for (const std::string& name : scenarios::ScenarioNames(folder)) {
      try {
        const bench::SweepPlan plan(bench::ReadSweep(folder + "/" + name + ".yaml"));
        sweeps.items.push_back({name, OneLine(plan.sweep().description) + " (" +
                                          std::to_string(plan.num_runs()) + " runs)"});
      } catch (const InputError& error) {
        faults_.push_back(error.what());
      }
    }
    kinds_.push_back(std::move(sweeps));
  }

  std::vector<Kind> kinds_;
  std::vector<std::string> faults_;
};

void PrintItems(const Kind& kind, bool is_alone) {
  const char* const indent = is_alone ? "" : "  ";
  for (const Item& item : kind.items) {
    const std::string text = item.note + (is_alone ? item.details : "");
    if (text.empty()) {
      Print("{}{}\n", indent, item.name);
    } else {
      Print("{}{:<24} {}\n", indent, item.name, text);
    }
  }
}

struct ListOptions {
  std::string kind;
  bool only_names = false;
  std::vector<std::string> models;
};

// Each fault has a line of its own, after all that is in order.
int List(const ListOptions& options) {
  const auto& [kind_name, only_names, models] = options;
  const Catalogue catalogue(FindDataPaths(models));
  std::vector<std::string> known;
  bool found = kind_name.empty();
  for (const Kind& kind : catalogue.kinds()) {
    known.emplace_back(kind.title);
    if (!kind_name.empty() && kind_name != kind.title) continue;
    found = true;
    if (only_names) {
      for (const Item& item : kind.items) Print("{}\n", item.name);
    } else {
      if (kind_name.empty()) Print("{}\n", kind.title);
      PrintItems(kind, !kind_name.empty());
    }
  }
  if (!found) {
    throw InputError("KIND", "must be one of " + Joined(known) + ", is '" + kind_name + "'");
  }
  const bool asks_for_files = kind_name.empty() || kind_name == "scenarios" ||
                              kind_name == "field_scenes" || kind_name == "sweeps";
  if (!asks_for_files) return 0;
  for (const std::string& fault : catalogue.faults()) PrintError("{}\n", fault);
  return catalogue.faults().empty() ? 0 : 2;
}

}  // namespace

void AddListCommand(CommandLine& line) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* const list = line.app.add_subcommand(
      "list",
      "List what can be named: scenarios, field scenes, sweeps, robots, knowledge, planners, "
      "predictors, sensors, metrics");
  list->add_option("KIND", options->kind, "Only this kind");
  list->add_flag("--names", options->only_names, "Only the names, one a line, for scripts");
  AddModels(*list, options->models);
  list->callback([&line, options] { line.exit_code = List(*options); });
}

}  // namespace sidestep::cli
