#pragma once

#include <string>

#include "sidestep/sim/model_store.h"
#include "sidestep/sim/mujoco_model.h"

namespace tinyxml2 {
class XMLDocument;
class XMLElement;
}  // namespace tinyxml2

namespace sidestep::sim {

/// The text of an MJCF file of models/, with the meshes that stand in files beside it
/// (sim/mesh_files.h). @throws InputError.
std::string ReadModelFile(const std::string& path);

/// The root of an MJCF text, which `document` owns then. Refuses at its line what no model of ours
/// may hold: references to files (MuJoCo would open them), elements that MuJoCo blows up to any
/// size, and sizes for which it would allocate without end.
/// @param name stands for the file in messages. @throws InputError.
const tinyxml2::XMLElement& ParseModel(const std::string& xml, const std::string& name,
                                       tinyxml2::XMLDocument* document);

/// Compiles an MJCF file of models/, checked like that. @throws InputError.
/// @param store of models that were compiled before, to which its own is added; may be null.
MujocoModelPtr LoadModelFile(const std::string& path, ModelStore* store = nullptr);

/// Compiles an MJCF text that came from elsewhere, such as that of a trace, if it is no more than
/// what BuildWorldXml (sim/world_xml.h) could have written: checked like that, of no other sections
/// than there, and not longer than 2 MiB. @throws InputError.
MujocoModelPtr LoadForeignModel(const std::string& xml, const std::string& name);

}  // namespace sidestep::sim
