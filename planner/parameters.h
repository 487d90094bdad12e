#pragma once

#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// What a planner lets a person set of it: declared by the planner, given by scenario files.
namespace sidestep::planner {

/// Number, whole number, switch, or word.
using ParameterValue = std::variant<double, int, bool, std::string>;
/// By name.
using Parameters = std::map<std::string, ParameterValue>;

/// One thing that can be set.
struct Parameter {
  std::string name;              ///< its key in scenario files, under `planner`
  ParameterValue default_value;  ///< every value is of this one's type
  std::string unit;              ///< "m", "s", ...; empty if it has none
  double least = -std::numeric_limits<double>::infinity();  ///< of a number; itself allowed
  double most = std::numeric_limits<double>::infinity();
  std::vector<std::string> words = {};  ///< what a word may be
  std::string meaning;                  ///< a line
};

/// "number", "whole number", "true or false", "word".
std::string TypeOf(const Parameter& parameter);
/// "from 0 to 100", "one of a, b", ...: what a value may be; empty if it may be anything of its
/// type.
std::string BoundsOf(const Parameter& parameter);
/// As a scenario file holds it.
std::string ToText(const ParameterValue& value);

/// @throws std::invalid_argument that says what is wrong with the text, without the name.
ParameterValue ParseValue(const Parameter& parameter, const std::string& text);
/// The same for a value: its type and bounds.
void CheckValue(const Parameter& parameter, const ParameterValue& value);

/// A value for everything that is declared: the given one, else the default.
/// @throws std::invalid_argument, naming the parameter, for a value that it may not have and for
///   one that is not declared.
Parameters Complete(const std::vector<Parameter>& declared, const Parameters& given);

/// The parameters that are members of a struct, whose own initial values are their defaults.
template <class Settings>
class ParameterTable {
 public:
  using Member = std::variant<double Settings::*, int Settings::*, bool Settings::*>;
  struct Row {
    const char* name;
    Member member;
    const char* unit;
    double least, most;
    const char* meaning;
  };
  explicit ParameterTable(std::vector<Row> rows) : rows_(std::move(rows)) {}

  std::vector<Parameter> declared() const {
    std::vector<Parameter> declared;
    for (const Row& row : rows_) {
      declared.push_back({.name = row.name,
                          .default_value = Get(Settings(), row.member),
                          .unit = row.unit,
                          .least = row.least,
                          .most = row.most,
                          .meaning = row.meaning});
    }
    return declared;
  }

  /// @throws std::invalid_argument as Complete does.
  Settings Read(const Parameters& given) const {
    const Parameters all = Complete(declared(), given);
    Settings settings;
    for (const Row& row : rows_) {
      std::visit(
          [&](auto member) {
            using Value = std::decay_t<decltype(settings.*member)>;
            settings.*member = std::get<Value>(all.at(row.name));
          },
          row.member);
    }
    return settings;
  }

 private:
  static ParameterValue Get(const Settings& settings, const Member& member) {
    return std::visit([&](auto one) { return ParameterValue(settings.*one); }, member);
  }
  std::vector<Row> rows_;
};

}  // namespace sidestep::planner
