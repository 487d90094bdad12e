#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "sidestep/core/grid.h"

namespace sidestep::sdf {

/// The part of a line that is in the box of the grid's cells, as two numbers from 0 (start) to 1
/// (end); empty if the first is not less than the second.
std::array<double, 2> PartInGrid(const GridSpec& grid, const Eigen::Vector3d& p_WStart,
                                 const Eigen::Vector3d& way_W);

/// Visits the cells of the grid that a straight line passes through from `start` to `end`, each
/// once, in order, as visit(cell, enter, leave), with the parts of the line, from 0 to 1, at which
/// it enters and leaves it. It goes on as long as that returns true.
/// Source: J. Amanatides, A. Woo, "A fast voxel traversal algorithm for ray tracing", Eurographics
/// 1987.
template <class Visit>
void VisitCellsOnLine(const GridSpec& grid, const Eigen::Vector3d& p_WStart,
                      const Eigen::Vector3d& p_WEnd, Visit visit) {
  const Eigen::Vector3d way = p_WEnd - p_WStart;
  const auto [first, last] = PartInGrid(grid, p_WStart, way);
  if (!(first < last)) return;
  std::array<int, 3> cell = grid.CellOf(p_WStart + first * way);
  std::array<int, 3> step;
  std::array<double, 3> next, length;  // parts of the line: to the next face, to cross one cell
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    cell[a] = std::clamp(cell[a], 0, grid.size[a] - 1);  // rounding, where the line enters
    step[a] = way(axis) > 0 ? 1 : -1;
    const double face = grid.first_center_m(axis) + grid.cell_m * (cell[a] + 0.5 * step[a]);
    const bool moves = way(axis) != 0;
    next[a] = moves ? (face - p_WStart(axis)) / way(axis) : std::numeric_limits<double>::infinity();
    length[a] = moves ? grid.cell_m / std::abs(way(axis)) : std::numeric_limits<double>::infinity();
  }
  const std::ptrdiff_t nx = grid.size[0], ny = grid.size[1];
  const std::array<std::ptrdiff_t, 3> stride = {step[0], step[1] * nx, step[2] * nx * ny};
  auto index = static_cast<std::ptrdiff_t>(grid.Index(cell[0], cell[1], cell[2]));
  double enter = first;
  while (true) {
    std::size_t a = next[1] < next[0] ? 1 : 0;
    if (next[2] < next[a]) a = 2;
    if (!visit(static_cast<std::size_t>(index), enter, std::min(next[a], last))) return;
    if (!(next[a] < last)) return;
    cell[a] += step[a];
    if (cell[a] < 0 || cell[a] >= grid.size[a]) return;
    index += stride[a];
    enter = next[a];
    next[a] += length[a];
  }
}

}  // namespace sidestep::sdf
