#include "sidestep/bench/reproduce/published_rasteriser.h"

#include <algorithm>
#include <cmath>

namespace sidestep::bench {

CellRange PublishedBoxCells(const GridSpec& grid, const Eigen::Vector3d& center_m,
                            const Eigen::Vector3d& size_m, BoxAlignment alignment) {
  CellRange cells;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t a = static_cast<std::size_t>(axis);
    const int half = static_cast<int>(std::round(size_m(axis) / grid.cell_m)) / 2;
    int middle =
        static_cast<int>(std::round((center_m(axis) - grid.first_center_m(axis)) / grid.cell_m));
    if (alignment == BoxAlignment::kOneCellLow) --middle;
    cells.first[a] = std::max(middle - half, 0);
    cells.last[a] = std::min(middle + half, grid.size[a] - 1);
  }
  return cells.empty() ? CellRange() : cells;
}

void Fill(OccupancyGrid& occupancy, const CellRange& cells) {
  for (int k = cells.first[2]; k <= cells.last[2]; ++k) {
    for (int j = cells.first[1]; j <= cells.last[1]; ++j) {
      for (int i = cells.first[0]; i <= cells.last[0]; ++i) {
        occupancy.cells[occupancy.spec.Index(i, j, k)] = 1;
      }
    }
  }
}

}  // namespace sidestep::bench
