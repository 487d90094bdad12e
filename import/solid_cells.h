#pragma once

#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/import/triangle_mesh.h"

namespace sidestep::imports {

/// The inside of closed meshes, by lines along x through the middle of the cells of a grid.
struct SolidCells {
  OccupancyGrid grid;    ///< a cell is filled where its centre is inside
  double volume_m3 = 0;  ///< of the union: the length of all lines inside, by their distance
};

/// Fills a grid around closed meshes, two free cells wider than they are on each side. Where meshes
/// overlap, or one overlaps itself, what is inside any of them is inside.
/// @param meshes of one frame, as CheckClosed wants them.
/// @param cells_along how many cells the longest edge of the box around them has, >= 1.
SolidCells FillCells(const std::vector<TriangleMesh>& meshes, int cells_along);

}  // namespace sidestep::imports
