#include "sidestep/cli/study_cases.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "sidestep/cli/option_lists.h"
#include "sidestep/cli/run_case.h"
#include "sidestep/cli/varied_keys.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/parse_number.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/scenarios/yaml_text.h"
#include "sidestep/sdf/prediction/registry.h"

namespace sidestep::cli {
namespace {

constexpr const char* kSeed = "seed";
constexpr const char* kSpeed = kSpeedFactor;

// Adds an axis, unless it has no values.
void AddAxis(bench::Sweep& sweep, const std::string& name, const std::vector<std::string>& values) {
  if (values.empty()) return;
  std::set<std::string> seen;
  for (const std::string& value : values) {
    if (!seen.insert(value).second) throw InputError(name, "'" + value + "' is given twice");
  }
  sweep.axes.push_back({name, values});
}

// The keys that --vary gives, each given once and by nothing else.
std::set<std::string> CheckVaried(const std::vector<VariedKeys>& varied,
                                  const std::vector<std::string>& settings) {
  std::set<std::string> keys;
  std::vector<std::string> all = settings;
  for (const VariedKeys& one : varied) {
    for (const auto& [key, value] : SettingsOf(one.factor, one.values.front())) {
      for (const auto& [factor, flag] : {std::pair(kSpeed, "--speed"),
                                         {kSeed, "--episodes"},
                                         {"knowledge", "--knowledge"},
                                         {"predictor", "--predictor"}}) {
        if (key == factor)
          throw InputError("--vary " + key, std::string("is what ") + flag + " varies");
      }
      keys.insert(key);
      all.push_back(key + "=" + value);
    }
  }
  ParseSettings(all);  // as if each value were set
  return keys;
}

// The values of a factor that a flag lists and that a setting may fix instead.
std::vector<std::string> ValuesOf(const std::string& factor, const char* flag,
                                  const std::vector<std::string>& listed,
                                  scenarios::Settings& settings) {
  const auto fixed = settings.find(factor);
  if (fixed == settings.end()) return listed;
  if (!listed.empty())
    throw InputError("--set " + factor, std::string("is what ") + flag + " varies");
  return {settings.extract(fixed).mapped()};
}

// What --set gives as the seed; it is no axis.
std::optional<std::uint64_t> TakeSeed(const StudySpace& space, scenarios::Settings& settings) {
  const auto fixed = settings.find(kSeed);
  if (fixed == settings.end()) return {};
  const std::string text = settings.extract(fixed).mapped();
  if (space.episodes > 0) throw InputError("--set seed", "is what --episodes varies");
  const auto seed = NumberIn<std::uint64_t>(text);
  if (!seed || HasLeadingZeros(text)) {
    throw InputError("--set seed", std::string("must be a whole number ") +
                                       (seed ? "without leading zeros" : ">= 0") + ", is '" + text +
                                       "'");
  }
  return seed;
}

std::uint64_t SeedIn(const std::string& scenario_file) {
  return scenarios::LoadScenario(scenario_file).seed;
}

}  // namespace

bench::Sweep SweepOf(const StudySpace& space, const DataPaths& paths) {
  std::vector<VariedKeys> varied;
  for (const std::string& text : space.varied) varied.push_back(ParseVariedKeys(text));
  const std::set<std::string> varied_keys = CheckVaried(varied, space.settings);
  scenarios::Settings settings = ParseSettings(space.settings);
  if (settings.count(kSpeed) != 0) {
    throw InputError(std::string("--set ") + kSpeed, "is what --speed varies");
  }
  const std::optional<std::uint64_t> fixed_seed = TakeSeed(space, settings);
  std::vector<std::string> speeds;
  for (const double speed : space.speeds) speeds.push_back(scenarios::Number(speed));
  const auto& asked = space.knowledge;
  std::vector<std::string> knowledge = ValuesOf("knowledge", "--knowledge", asked, settings);
  if (std::find(knowledge.begin(), knowledge.end(), kSearch) != knowledge.end()) {
    throw InputError(asked.empty() ? "--set knowledge" : "--knowledge",
                     "'search' is asked for by --search");
  }
  CheckWords("--knowledge", asked, KnowledgeWords());
  CheckWords("--predictor", space.predictors, sdf::PredictorNames());
  if (space.search > 0) knowledge.push_back(kSearch);
  const std::vector<std::string> predictors =
      ValuesOf("predictor", "--predictor", space.predictors, settings);
  const std::string file = FindScenario(space.scenario, paths);
  bench::Sweep sweep;
  sweep.name = std::filesystem::path(file).stem().string();
  sweep.scenarios = {space.scenario};
  sweep.search = space.search;
  for (const auto& [choice, values] : scenarios::ScenarioChoices(file)) {
    const bool is_given = settings.count(choice) != 0 || varied_keys.count(choice) != 0;
    if (!is_given) AddAxis(sweep, choice, values);
  }
  for (const auto& [key, value] : settings) AddAxis(sweep, key, {value});
  for (const VariedKeys& keys : varied) AddAxis(sweep, keys.factor, keys.values);
  AddAxis(sweep, kSpeed, speeds);
  AddAxis(sweep, "knowledge", knowledge);
  AddAxis(sweep, "predictor", predictors);
  sweep.seeds.clear();
  for (int seed = 1; seed <= space.episodes; ++seed) {
    sweep.seeds.push_back(static_cast<std::uint64_t>(seed));
  }
  if (space.episodes == 0) sweep.seeds = {fixed_seed.value_or(SeedIn(file))};
  return sweep;
}

}  // namespace sidestep::cli
