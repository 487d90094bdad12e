#pragma once

#include <string>
#include <vector>

#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// A mesh as it was read, and what a person should know of it.
struct LoadedMesh {
  TriangleMesh mesh;               ///< [m], z up
  std::vector<std::string> notes;  ///< each begins with a verb: "is inside out", ...
};

struct MeshReading {
  /// Whether a COLLADA file whose up axis is y or x is turned so that it is z, as the robot's is.
  /// RViz takes it as it is.
  bool turn_up_axis = true;
};

/// Reads an STL (text or binary), OBJ or COLLADA (DAE) file: all its triangles, the transforms of
/// its nodes, the unit and the up axis that a COLLADA file names applied.
/// @throws InputError for a file that is missing, too large (256 MiB), no such mesh, or holds a
/// vertex that is not finite, or no triangle.
LoadedMesh LoadMesh(const std::string& path, const MeshReading& reading);

}  // namespace sidestep::imports
