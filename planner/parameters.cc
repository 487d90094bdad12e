#include "sidestep/planner/parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/parse_number.h"

namespace sidestep::planner {
namespace {

constexpr const char* kTypes[] = {"number", "whole number", "true or false", "word"};

std::optional<ParameterValue> ParseAs(const ParameterValue& like, const std::string& text) {
  if (std::holds_alternative<std::string>(like)) return text;
  if (std::holds_alternative<bool>(like)) {
    if (text == "true") return true;
    if (text == "false") return false;
    return std::nullopt;
  }
  if (std::holds_alternative<int>(like)) return NumberIn<int>(text);
  return NumberIn<double>(text);
}

std::vector<std::string> NamesOf(const std::vector<Parameter>& declared) {
  std::vector<std::string> names;
  for (const Parameter& parameter : declared) names.push_back(parameter.name);
  return names;
}

}  // namespace

std::string TypeOf(const Parameter& parameter) { return kTypes[parameter.default_value.index()]; }

std::string BoundsOf(const Parameter& parameter) {
  if (!parameter.words.empty()) return "one of " + Joined(parameter.words);
  const bool has_least = std::isfinite(parameter.least), has_most = std::isfinite(parameter.most);
  const auto text = [&](double bound) {
    const bool is_whole = std::holds_alternative<int>(parameter.default_value);
    return is_whole ? std::to_string(std::llround(bound)) : ShortestText(bound);
  };
  if (has_least && has_most) {
    return "from " + text(parameter.least) + " to " + text(parameter.most);
  }
  if (has_least) return "at least " + text(parameter.least);
  return has_most ? "at most " + text(parameter.most) : "";
}

std::string ToText(const ParameterValue& value) {
  if (const auto* const number = std::get_if<double>(&value)) return ShortestText(*number);
  if (const auto* const whole = std::get_if<int>(&value)) return std::to_string(*whole);
  if (const auto* const flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return std::get<std::string>(value);
}

ParameterValue ParseValue(const Parameter& parameter, const std::string& text) {
  const std::optional<ParameterValue> value = ParseAs(parameter.default_value, text);
  if (!value) {
    throw std::invalid_argument("must be a " + TypeOf(parameter) + ", is '" + text + "'");
  }
  const bool is_number =
      std::holds_alternative<double>(*value) || std::holds_alternative<int>(*value);
  if (is_number && HasLeadingZeros(text)) {
    throw std::invalid_argument("must be a " + TypeOf(parameter) + " without leading zeros, is '" +
                                text + "'");
  }
  CheckValue(parameter, *value);
  return *value;
}

void CheckValue(const Parameter& parameter, const ParameterValue& value) {
  const auto require = [&](bool condition) {
    if (condition) return;
    throw std::invalid_argument("must be " + BoundsOf(parameter) + ", is " + ToText(value));
  };
  if (value.index() != parameter.default_value.index()) {
    throw std::invalid_argument("must be a " + TypeOf(parameter) + ", is " + ToText(value));
  }
  const auto within = [&](double number) {  // false for what is not a number
    return number >= parameter.least && number <= parameter.most;
  };
  if (const auto* const number = std::get_if<double>(&value)) require(within(*number));
  if (const auto* const whole = std::get_if<int>(&value)) require(within(*whole));
  if (const auto* const word = std::get_if<std::string>(&value)) {
    const std::vector<std::string>& words = parameter.words;
    require(words.empty() || std::find(words.begin(), words.end(), *word) != words.end());
  }
}

Parameters Complete(const std::vector<Parameter>& declared, const Parameters& given) {
  Parameters all;
  for (const Parameter& parameter : declared) {
    const auto found = given.find(parameter.name);
    const ParameterValue& value = found == given.end() ? parameter.default_value : found->second;
    try {
      CheckValue(parameter, value);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(parameter.name + ": " + error.what());
    }
    all[parameter.name] = value;
  }
  for (const auto& [name, value] : given) {
    if (all.count(name) == 0) {
      throw std::invalid_argument(name + ": is no parameter of this planner (there are: " +
                                  Joined(NamesOf(declared)) + ")");
    }
  }
  return all;
}

}  // namespace sidestep::planner
