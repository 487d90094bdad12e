#pragma once

#include <string>

namespace sidestep::sim {

/// An MJCF text in which each mesh that stands in a file beside the model (`file=`: STL or OBJ)
/// is given by the corners of its convex hull instead, `vertex=`, which is all that
/// a simulation makes of it: so the text refers to no other file. Lines keep their numbers.
/// @param path of the MJCF file: meshes lie in its folder, or below (its `meshdir`).
/// @throws InputError at the line of a mesh that is missing, elsewhere, or no solid.
std::string InlineMeshFiles(const std::string& xml, const std::string& path);

}  // namespace sidestep::sim
