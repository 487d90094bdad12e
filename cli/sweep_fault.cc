#include "sidestep/cli/sweep_fault.h"

#include <optional>
#include <string>

#include "sidestep/cli/run_case.h"
#include "sidestep/cli/varied_keys.h"

namespace sidestep::cli {
namespace {

// A key that a sweep gives, or a part of what it gives.
bool IsWithin(const std::string& path, const std::string& key) {
  return path == key || path.starts_with(key + ".") || path.starts_with(key + "[");
}

// How the sweep's file calls what holds `path`, and its key there.
struct Place {
  std::string key, shown;
};

std::optional<Place> PlaceOf(const bench::Sweep& sweep, const std::string& path) {
  if (path == "SCENARIO") return Place{"scenarios", "scenarios"};
  for (const bench::SweepAxis& axis : sweep.axes) {
    for (const auto& [key, value] : SettingsOf(axis.name, axis.values.front())) {
      if (IsWithin(path, key)) return Place{"axes." + axis.name, "axes." + path};
    }
  }
  if (IsWithin(path, "variations") && sweep.lines.contains("variations")) {
    return Place{"variations", path};
  }
  for (const auto& [key, value] : sweep.settings) {
    if (IsWithin(path, key)) return Place{"set." + key, "set." + path};
  }
  return std::nullopt;
}

}  // namespace

InputError FaultInSweep(const bench::Sweep& sweep, const InputError& fault) {
  std::string text = fault.what();
  if (text.substr(0, text.find(": ")).ends_with(".yaml")) text = "SCENARIO: " + text;  // no line
  text = FaultByFactor(text);
  const std::size_t colon = text.find(": ");
  if (sweep.file.empty() || colon == std::string::npos) return fault;
  const std::optional<Place> place = PlaceOf(sweep, text.substr(0, colon));
  if (!place) return fault;
  const auto line = sweep.lines.find(place->key);
  return {sweep.file, line == sweep.lines.end() ? 1 : line->second, place->shown,
          text.substr(colon + 2)};
}

}  // namespace sidestep::cli
