#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <sstream>
#include <string>

namespace sidestep::cli {

/// A check for options: a number from `least` to `most`, both included. CLI::Range takes NaN.
inline CLI::Validator NumberFrom(double least, double most) {
  std::ostringstream range;
  range << "from " << least << " to " << most;
  const auto check = [least, most, text = range.str()](const std::string& word) {
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto parsed = std::from_chars(word.data(), end, value);
    const bool is_inside =
        parsed.ec == std::errc() && parsed.ptr == end && value >= least && value <= most;
    return is_inside ? std::string() : "must be a number " + text + ", is '" + word + "'";
  };
  return CLI::Validator(check, "", "number");
}

}  // namespace sidestep::cli
