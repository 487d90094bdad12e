#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace sidestep::bench {

/// JSON for a file of its own: indented, with a line end. Bytes that are not UTF-8, which JSON
/// cannot hold, are written out (core/utf8.h).
std::string JsonText(nlohmann::ordered_json json);

/// The same on one line, without its end.
std::string JsonLine(nlohmann::ordered_json json);

/// A number as JSON has it, which knows neither NaN nor infinity: null.
nlohmann::ordered_json NumberOrNull(double value);
/// The same read back.
template <typename Json>
double NumberOrNaN(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.template get<double>();
}

}  // namespace sidestep::bench
