#pragma once

#include "sidestep/import/link_solids.h"

namespace sidestep::imports {

/// Checks that a mesh bounds a solid: finite, with triangles, each edge between two of them that
/// run along it in opposite ways (corners at the same place count as one, as files of loose
/// triangles have them), and its outside outside.
/// @throws InputError `NAME: WHY`.
void CheckClosed(const NamedMesh& solid);

/// For each vertex, the first one at exactly the same place.
std::vector<int> FirstOfEachPlace(const TriangleMesh& mesh);

}  // namespace sidestep::imports
