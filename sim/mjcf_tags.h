#pragma once

#include <cstddef>
#include <string_view>

namespace sidestep::sim {

/// A tag of an XML text, from its < to behind its >.
struct XmlTag {
  std::size_t begin = 0, end = 0;
};

/// Finds the next tag `<name` at or after `from`, outside of comments; `/name` finds an end.
/// @return whether there is one.
bool FindTag(std::string_view xml, std::string_view name, std::size_t from, XmlTag* tag);

}  // namespace sidestep::sim
