#pragma once

#include <string>

namespace sidestep {

// A robot is named by its folder of models/, or by a path to one, or by that and a variant, as in
// `panda:covered`: then <folder>/<variant>.yaml describes it, and not <folder>/robot.yaml.

/// Empty if there is none.
inline std::string ModelVariant(const std::string& name) {
  const std::size_t colon = name.rfind(':');
  const bool is_one = colon != std::string::npos && name.find('/', colon) == std::string::npos;
  return is_one ? name.substr(colon + 1) : "";
}

inline std::string ModelFolder(const std::string& name) {
  const std::string variant = ModelVariant(name);
  return variant.empty() ? name : name.substr(0, name.size() - variant.size() - 1);
}

/// The file in the robot's folder that describes it; an empty variant: the robot itself.
inline std::string DescriptionFile(const std::string& variant) {
  return (variant.empty() ? "robot" : variant) + ".yaml";
}

}  // namespace sidestep
