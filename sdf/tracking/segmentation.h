#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sidestep/core/grid.h"

namespace sidestep::sdf {

/// Filled cells that hang together.
struct Component {
  std::vector<std::size_t> cells;  ///< by GridSpec::Index, ascending, never empty
  Eigen::Vector3d centroid_m;      ///< mean of the cells' centres
  std::array<int, 3> first;        ///< the box of cells around it, both corners included
  std::array<int, 3> last;
};

/// Splits the filled cells into 26-connected components (cells that share a face, an edge or a
/// corner belong together), in the order of their lowest cell.
///
/// It works on runs of filled cells along x, so that a grid costs little more than a look at it.
///
/// @param left_out one byte a cell: where it is not 0, the cell counts as free.
/// @throws std::invalid_argument for a `left_out` of another size.
std::vector<Component> FindComponents(const OccupancyGrid& occupancy,
                                      std::span<const std::uint8_t> left_out);
std::vector<Component> FindComponents(const OccupancyGrid& occupancy);

/// These cells as a component, whether or not they hang together.
/// @param cells ascending, not empty.
Component MakeComponent(std::vector<std::size_t> cells, const GridSpec& grid);

/// The cell (i, j, k) of an index.
std::array<int, 3> CellAt(const GridSpec& grid, std::size_t index);

/// The component alone, in a grid that fits its box, in W.
OccupancyGrid CutOut(const Component& component, const GridSpec& grid);

}  // namespace sidestep::sdf
