#pragma once

#include "sidestep/core/solid.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// A closed convex mesh around a shape, in the frame that the shape is placed in: all of the shape
/// is within it, and none of it is further than `tolerance_m` outside the shape (further for a
/// curved shape larger than 26000 times that: it has at most 512 corners around).
/// @param tolerance_m > 0.
TriangleMesh OuterMesh(const PlacedShape& placed, double tolerance_m);

}  // namespace sidestep::imports
