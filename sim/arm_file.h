#pragma once

#include <string>

#include "sidestep/sim/mujoco_model.h"

namespace tinyxml2 {
class XMLElement;
}  // namespace tinyxml2

namespace sidestep::sim {

/// Refuses at its line what a world cannot take over from a robot's MJCF: sections other than those
/// of its body, drive and senses; anything beside its one root body; ties other than of joints. So
/// nothing of the file is left out of the simulation without a word.
/// @param root as of ParseModel. @param name stands for the file in messages. @throws InputError.
void CheckArmFile(const tinyxml2::XMLElement& root, const std::string& name);

/// Compiles a robot's MJCF by itself, checked like that and as ParseModel does. @throws InputError.
MujocoModelPtr LoadArmFile(const std::string& path);

/// The same of a text. @param name stands for the file in messages.
MujocoModelPtr LoadArmText(const std::string& xml, const std::string& name);

}  // namespace sidestep::sim
