#pragma once

#include <string>
#include <vector>

namespace sidestep::robot {

/// The variants of the robot in a folder (core/model_name.h), sorted, as `panda:covered`: the files
/// beside its robot.yaml that extend a robot.
std::vector<std::string> VariantNames(const std::string& folder);

}  // namespace sidestep::robot
