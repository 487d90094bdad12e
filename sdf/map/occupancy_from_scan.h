#pragma once

#include "core/grid.h"
#include "core/observations.h"

namespace sidestep {

/// Fills the cells that hold at least one point of the scan. Points outside the grid are left out,
/// and so are points that are not finite (a camera's pixels without depth).
/// @throws std::invalid_argument for a bad grid.
OccupancyGrid FillFromScan(const Scan& scan, const GridSpec& grid_W);

}  // namespace sidestep
