#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "core/grid.h"

namespace sidestep {

/// Filled cells that hang together.
struct Component {
  std::vector<std::size_t> cells;  ///< by GridSpec::Index, ascending, never empty
  Eigen::Vector3d centroid_m;      ///< mean of the cells' centres
  std::array<int, 3> first;        ///< the box of cells around it, both corners included
  std::array<int, 3> last;
};

/// Splits the filled cells into 26-connected components (cells that share a face, an edge or a
/// corner belong together), in the order of their lowest cell.
std::vector<Component> FindComponents(const OccupancyGrid& occupancy);

/// The component alone, in a grid that fits its box, in W.
OccupancyGrid CutOut(const Component& component, const GridSpec& grid);

}  // namespace sidestep
