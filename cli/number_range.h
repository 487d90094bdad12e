#pragma once

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "sidestep/core/parse_number.h"

namespace sidestep::cli {

/// A check for options: a number from `least` to `most`, both included. CLI::Range takes NaN, and
/// CLI11 reads 010 as eight.
inline CLI::Validator NumberFrom(double least, double most) {
  const std::string range = fmt::format("from {:.10g} to {:.10g}", least, most);
  const auto check = [least, most, range](const std::string& word) {
    const std::optional<double> value = NumberIn<double>(word);
    const bool is_inside = value && *value >= least && *value <= most;
    if (is_inside && !HasLeadingZeros(word)) return std::string();
    return "must be a number " + range + (is_inside ? " without leading zeros" : "") + ", is '" +
           word + "'";
  };
  return CLI::Validator(check, "", "number");
}

}  // namespace sidestep::cli
