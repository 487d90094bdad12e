#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cctype>
#include <string>

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::scenarios {

inline std::string Number(double value) { return ShortestText(value); }

/// [1, 2.5, 3]
inline std::string List(const Eigen::VectorXd& values) {
  return "[" + Joined(values, ", ", &Number) + "]";
}

/// Any text as a double-quoted YAML scalar.
inline std::string Quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? std::string("\\n") : std::string(1, c);
  }
  return "\"" + quoted + "\"";
}

/// Whether a text is fit for a name: letters, digits, _ and -.
inline bool IsPlainName(const std::string& name) {
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

}  // namespace sidestep::scenarios
