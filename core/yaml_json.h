#pragma once

#include <string>

namespace sidestep {

/// The same value as JSON, for programs that read no YAML: numbers, `true`, `false` and `null` that
/// are not in quotes are such, every other scalar is a string; keys stay in their order.
/// @param yaml one document that is known to be sound, such as the text of a Scenario.
/// @throws std::invalid_argument if it is not.
std::string YamlToJson(const std::string& yaml);

}  // namespace sidestep
