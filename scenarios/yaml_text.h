#pragma once

#include <Eigen/Core>
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

}  // namespace sidestep::scenarios
