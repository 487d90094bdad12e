#pragma once

#include <string>
#include <vector>

namespace sidestep::robot {

// A robot is named by its folder of models/, or by that and a variant, as in `panda:covered`: then
// <folder>/<variant>.yaml is read, and not <folder>/robot.yaml.

inline std::string ModelFolder(const std::string& name) { return name.substr(0, name.find(':')); }

/// Empty if there is none.
inline std::string ModelVariant(const std::string& name) {
  const std::size_t colon = name.find(':');
  return colon == std::string::npos ? "" : name.substr(colon + 1);
}

/// The file in the robot's folder that describes it; an empty variant: the robot itself.
inline std::string DescriptionFile(const std::string& variant) {
  return (variant.empty() ? "robot" : variant) + ".yaml";
}

/// The variants of the robot in a folder, sorted, as `panda:covered`: the files beside its
/// robot.yaml that extend a robot.
std::vector<std::string> VariantNames(const std::string& folder);

}  // namespace sidestep::robot
