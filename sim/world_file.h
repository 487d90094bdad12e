#pragma once

#include <string>

namespace sidestep::sim {

/// Refuses at its line, in an MJCF file from elsewhere and in those that it includes, what MuJoCo
/// would blow up to any size, numbers that are none, and meshes without a volume. Meshes and
/// pictures in files of their own are not looked into. @throws InputError.
void CheckWorldFile(const std::string& path);

}  // namespace sidestep::sim
