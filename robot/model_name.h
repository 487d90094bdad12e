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

/// `<models_dir>/<folder>/<folder>.xml`: a variant has the body of its robot.
inline std::string MjcfPath(const std::string& models_dir, const std::string& name) {
  return models_dir + "/" + ModelFolder(name) + "/" + ModelFolder(name) + ".xml";
}

/// The variants of a robot, sorted, as `panda:covered`: the files beside its robot.yaml that extend
/// a robot.
std::vector<std::string> VariantNames(const std::string& models_dir, const std::string& folder);

}  // namespace sidestep::robot
