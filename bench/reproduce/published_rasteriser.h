#pragma once

#include <Eigen/Core>
#include <array>

#include "sidestep/core/grid.h"

namespace sidestep::bench {

/// Rasteriser convention `published`: which cells the authors' code fills for an axis-aligned box.
///
/// Along each axis the box takes n = round(size / cell) cells, the half h = floor(n / 2), and fills
/// m - h ... m + h around m = round((center - first centre) / cell): 2 floor(n / 2) + 1 cells, so
/// an even n gains one. `round` is half away from zero, and the quotients are true divisions: many
/// published sizes and positions are exact ties.
///
/// Source: ori-drs/gpmp2 (BSD-3-Clause), as of Finean, Merkt & Havoutis (ICAPS 2021).
enum class BoxAlignment {
  /// The middle cell is m: the authors' moving boxes, and what they meant for all.
  kIntended,
  /// The middle cell is m - 1 on every axis: the authors' static boxes, which a slip between
  /// counting from one and from zero sets one cell low in x, y and z.
  kOneCellLow,
};

/// Cells first ... last along each axis, both included; empty along an axis if last < first.
struct CellRange {
  std::array<int, 3> first = {0, 0, 0};
  std::array<int, 3> last = {-1, -1, -1};

  bool empty() const { return last[0] < first[0] || last[1] < first[1] || last[2] < first[2]; }
  auto operator<=>(const CellRange&) const = default;
};

/// The cells of a box, clipped to the grid.
CellRange PublishedBoxCells(const GridSpec& grid, const Eigen::Vector3d& center_m,
                            const Eigen::Vector3d& size_m, BoxAlignment alignment);

/// @param cells must lie within the grid, or be empty.
void Fill(OccupancyGrid& occupancy, const CellRange& cells);

}  // namespace sidestep::bench
