#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sidestep::cli {

/// A factor of a study by keys of the scenario's file: one key, or several that vary together,
/// KEY/OTHER, whose values are then pairs, VALUE/VALUE.
struct VariedKeys {
  std::string factor;
  std::vector<std::string> values;
};

/// Reads `KEY=VALUE,VALUE,...` or `KEY/OTHER=VALUE/VALUE,VALUE/VALUE,...`. What stands in brackets,
/// braces or quotes is not cut apart.
/// @throws InputError.
VariedKeys ParseVariedKeys(const std::string& text);

/// What one value of a factor sets: keys and values. Of a factor that is no combination of keys:
/// itself.
std::vector<std::pair<std::string, std::string>> SettingsOf(const std::string& factor,
                                                            const std::string& value);

}  // namespace sidestep::cli
