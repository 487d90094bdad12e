#include "sidestep/sim/static_cells.h"

#include "sidestep/sim/rasteriser.h"
#include "sidestep/sim/world_geoms.h"

namespace sidestep::sim {

Eigen::Matrix3Xd StaticCells(const World& world, const GridSpec& grid, CellRule rule) {
  CheckGridSpec(grid);
  const Rasteriser rasteriser(world.model(), rule);
  OccupancyGrid occupancy(grid);
  for (const int geom : FindWorldGeoms(world.model()).fixed) {
    rasteriser.Fill(world.data(), geom, &occupancy);
  }
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(occupancy.CountFilled()));
  Eigen::Index n = 0;
  for (std::size_t cell = 0; cell < occupancy.cells.size(); ++cell) {
    if (occupancy.cells[cell] != 0) points.col(n++) = grid.CenterOf(cell);
  }
  return points;
}

}  // namespace sidestep::sim
