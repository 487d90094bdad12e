#pragma once

#include <string>
#include <vector>

#include "sidestep/core/solid.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// A mesh and what it is called in messages, such as its file.
struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

/// What one link is made of, in the link's frame. Solids may overlap.
struct LinkSolids {
  std::vector<PlacedShape> shapes;  ///< X_WO: in the link's frame
  std::vector<NamedMesh> meshes;    ///< closed; convex or not
};

}  // namespace sidestep::imports
