#include "sidestep/cli/study_cases.h"

#include <algorithm>
#include <set>
#include <utility>

#include "sidestep/cli/option_lists.h"
#include "sidestep/cli/run_case.h"
#include "sidestep/cli/varied_keys.h"
#include "sidestep/core/input_error.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/scenarios/yaml_text.h"
#include "sidestep/sdf/prediction/registry.h"

namespace sidestep::cli {
namespace {

constexpr const char* kSeed = "seed";
constexpr const char* kSpeed = kSpeedFactor;

// Every combination of `cases` with the values of one more factor.
std::vector<bench::Factors> Cross(const std::vector<bench::Factors>& cases,
                                  const std::string& factor,
                                  const std::vector<std::string>& values) {
  if (values.empty()) return cases;
  std::set<std::string> seen;
  for (const std::string& value : values) {
    if (!seen.insert(value).second) throw InputError(factor, "'" + value + "' is given twice");
  }
  std::vector<bench::Factors> crossed;
  for (const bench::Factors& one : cases) {
    for (const std::string& value : values) {
      crossed.push_back(one);
      crossed.back()[factor] = value;
    }
  }
  return crossed;
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

}  // namespace

std::vector<bench::Factors> StudyCases(const StudySpace& space, const DataPaths& paths) {
  std::vector<VariedKeys> varied;
  for (const std::string& text : space.varied) varied.push_back(ParseVariedKeys(text));
  const std::set<std::string> varied_keys = CheckVaried(varied, space.settings);
  scenarios::Settings settings = ParseSettings(space.settings);
  if (settings.count(kSpeed) != 0) {
    throw InputError(std::string("--set ") + kSpeed, "is what --speed varies");
  }
  std::vector<std::string> speeds, seeds;
  for (const double speed : space.speeds) speeds.push_back(scenarios::Number(speed));
  for (int seed = 1; seed <= space.episodes; ++seed) seeds.push_back(std::to_string(seed));
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
  seeds = ValuesOf(kSeed, "--episodes", seeds, settings);

  std::vector<bench::Factors> cases = {{}};
  for (const auto& [choice, values] :
       scenarios::ScenarioChoices(FindScenario(space.scenario, paths))) {
    const bool is_given = settings.count(choice) != 0 || varied_keys.count(choice) != 0;
    if (!is_given) cases = Cross(cases, choice, values);
  }
  for (const auto& [key, value] : settings) cases = Cross(cases, key, {value});
  for (const VariedKeys& keys : varied) cases = Cross(cases, keys.factor, keys.values);
  cases = Cross(cases, kSpeed, speeds);
  cases = Cross(cases, "knowledge", knowledge);
  cases = Cross(cases, "predictor", predictors);
  return Cross(cases, kSeed, seeds);
}

bench::TableAxes ChooseAxes(const std::vector<bench::Factors>& cases, bench::TableAxes axes) {
  std::vector<std::string> varying;
  std::string known;
  for (const auto& entry : cases.front()) {
    const std::string& factor = entry.first;
    known += (known.empty() ? "" : ", ") + factor;
    const bool varies = std::any_of(cases.begin(), cases.end(), [&](const bench::Factors& one) {
      return one.at(factor) != entry.second;
    });
    const bool is_taken = factor == axes.down || factor == axes.across || factor == kSeed;
    if (varies && !is_taken) varying.push_back(factor);
  }
  const auto check = [&](const char* flag, const std::string& factor) {
    if (factor.empty() || cases.front().count(factor) != 0) return;
    throw InputError(flag, "'" + factor + "' is no factor of this study (" +
                               (known.empty() ? "it has none: nothing is given to vary"
                                              : "there are: " + known) +
                               ")");
  };
  check("--down", axes.down);
  check("--across", axes.across);
  if (!axes.down.empty() && axes.down == axes.across) {
    throw InputError("--across", "'" + axes.across + "' is listed down already");
  }
  const bool one_goes_down = axes.down.empty() && varying.size() == 1;
  if (axes.across.empty() && !varying.empty() && !one_goes_down) {
    for (const std::string& factor :
         {std::string("knowledge"), std::string("predictor"), varying.back()}) {
      if (std::erase(varying, factor) == 0) continue;
      axes.across = factor;
      break;
    }
  }
  if (axes.down.empty() && !varying.empty()) axes.down = varying.front();
  return axes;
}

}  // namespace sidestep::cli
