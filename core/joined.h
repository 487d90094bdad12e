#pragma once

#include <string>

namespace sidestep {

/// Items in a row, each as `spell` says it in a std::string.
template <class Items, class Spell>
std::string Joined(const Items& items, const char* separator, Spell spell) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : separator) + spell(item);
  return text;
}

/// Names in a row, `a, b, c`, as messages list what there is.
/// @param names a range of strings.
template <class Names>
std::string Joined(const Names& names, const char* separator = ", ") {
  return Joined(names, separator, [](const std::string& name) { return name; });
}

}  // namespace sidestep
