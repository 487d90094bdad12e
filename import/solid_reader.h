#pragma once

#include <string>
#include <vector>

#include "sidestep/import/arm_choices.h"
#include "sidestep/import/urdf_file.h"
#include "sidestep/robot/arm_description.h"

namespace sidestep::imports {

/// What of a URDF's link can touch. Adds to `notes` what was made of its meshes.
/// @throws InputError at the line of a solid that cannot be one.
std::vector<robot::LinkSolid> ReadSolids(const UrdfFile& file, const urdf::Link& link,
                                         const ArmChoices& choices,
                                         std::vector<std::string>* notes);

}  // namespace sidestep::imports
