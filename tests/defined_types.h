#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// A class, struct, union or enumeration that C++ source defines at the level of a namespace.
struct DefinedType {
  std::string name;  ///< with its namespaces, e.g. "sidestep::sdf::SdfGrid"
  int line = 0;      ///< of its name, counted from 1
};

/// Those of a file's text, in order, without what has internal linkage (an unnamed namespace).
/// Declarations, aliases, specialisations, template parameters and types inside of others are none.
std::vector<DefinedType> FindDefinedTypes(const std::string& text);

}  // namespace sidestep
