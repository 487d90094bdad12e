#pragma once

#include <string>

namespace sidestep {

/// Names in a row, `a, b, c`, as messages list what there is.
/// @param names a range of strings.
template <class Names>
std::string Joined(const Names& names, const char* separator = ", ") {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : separator) + name;
  return text;
}

}  // namespace sidestep
