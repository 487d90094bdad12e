#pragma once

#include <Eigen/Core>

#include "sidestep/core/cell_touch.h"
#include "sidestep/core/grid.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// The centres of the cells that the world's fixed solids fill (3 x N, m), robot and floor left
/// out: what a sensor of tags knows beforehand.
Eigen::Matrix3Xd StaticCells(const World& world, const GridSpec& grid, CellRule rule);

}  // namespace sidestep::sim
