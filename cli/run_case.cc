#include "sidestep/cli/run_case.h"

#include <optional>

#include "sidestep/cli/shell_quote.h"
#include "sidestep/cli/varied_keys.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/parse_number.h"

namespace sidestep::cli {
namespace {

double SpeedOf(const std::string& text) {
  constexpr double kMost_m_s = 100;
  const std::optional<double> speed_m_s = NumberIn<double>(text);
  if (!speed_m_s || !(*speed_m_s >= 0 && *speed_m_s <= kMost_m_s)) {
    throw InputError(kSpeedFactor, "must be a number from 0 to 100, is '" + text + "'");
  }
  return *speed_m_s;
}

}  // namespace

std::string FaultByFactor(const std::string& fault) {
  for (const std::string flag : {"--set ", "--speed: ", "--"}) {
    if (!fault.starts_with(flag)) continue;
    return (flag == "--speed: " ? std::string(kSpeedFactor) + ": " : "") +
           fault.substr(flag.size());
  }
  return fault;
}

bool IsSearch(const bench::Factors& factors) {
  const auto knowledge = factors.find("knowledge");
  return knowledge != factors.end() && knowledge->second == kSearch;
}

Problem LoadCase(const std::string& scenario, const bench::Factors& factors, const DataPaths& paths,
                 CheckedRobots* robots) {
  Overrides overrides;
  for (const auto& [factor, value] : factors) {
    if (factor == kSpeedFactor) {
      overrides.speed_m_s = SpeedOf(value);
    } else if (factor == "knowledge") {
      if (value != kSearch) overrides.knowledge = value;
    } else if (factor == "predictor") {
      overrides.predictor = value;
    } else {
      for (const auto& [key, one] : SettingsOf(factor, value)) overrides.settings[key] = one;
    }
  }
  return LoadProblem(scenario, overrides, paths, robots);
}

std::string RunCommandOf(const std::string& scenario, const bench::Factors& factors) {
  if (IsSearch(factors)) return "";
  std::string command = "sidestep run " + ShellQuoted(scenario);
  for (const auto& [factor, value] : factors) {
    if (factor == kSpeedFactor) {
      command += " --speed " + ShellQuoted(value);
    } else if (factor == "knowledge" || factor == "predictor" || factor == "seed") {
      command += " --" + factor + " " + ShellQuoted(value);
    } else {
      for (const auto& [key, one] : SettingsOf(factor, value)) {
        command += " --set " + ShellQuoted(key + "=" + one);
      }
    }
  }
  return command;
}

}  // namespace sidestep::cli
