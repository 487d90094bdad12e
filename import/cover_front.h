#pragma once

#include <vector>

#include "sidestep/import/cover_sphere.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// A cover of one link.
struct SphereCover {
  std::vector<CoverSphere> spheres;
  double volume_m3 = 0;  ///< of their union
};

/// Covers of one link within one tolerance, each with another number of spheres, from few to many;
/// each has less volume than those before it.
using CoverFront = std::vector<SphereCover>;

/// What a search for covers works on.
struct CoverTask {
  std::vector<TriangleMesh> meshes;  ///< what is to be covered; closed, at least one
  double cover_m = 0;                ///< > 0: no point of them sticks out further, for certain
  int most_spheres = 0;              ///< >= 1: of a cover
  double steps_per_m = 0;            ///< > 0: centres and radii are whole numbers of these steps
};

/// First a greedy choice among balls around points inside, of many sizes; then one sphere after the
/// other is taken away, and the others make up for it, and shrink (shrink_cover.h); of few spheres,
/// each is also split in two. Always finds at least one cover.
CoverFront FindCovers(const CoverTask& task);

}  // namespace sidestep::imports
