#pragma once

#include <Eigen/Core>
#include <algorithm>
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

/// Which blocks of neighbouring cells (by GridSpec::Index) may hold something, so that what is
/// known to hold nothing need not be searched.
class SearchBlocks {
 public:
  static constexpr std::size_t kCells = 256;

  /// All may.
  explicit SearchBlocks(std::size_t num_cells) : may_hold_((num_cells + kCells - 1) / kCells, 1) {}

  void MarkAll() { std::fill(may_hold_.begin(), may_hold_.end(), std::uint8_t{1}); }
  void Mark(std::size_t cell) { may_hold_[cell / kCells] = 1; }
  void Clear(std::size_t block) { may_hold_[block] = 0; }

  std::size_t num_blocks() const { return may_hold_.size(); }
  bool may_hold(std::size_t block) const { return may_hold_[block] != 0; }

 private:
  std::vector<std::uint8_t> may_hold_;
};

/// Splits the filled cells into 26-connected components (cells that share a face, an edge or a
/// corner belong together), in the order of their lowest cell.
///
/// It works on runs of filled cells along x, so that a grid costs little more than a look at it.
///
/// @param left_out one byte a cell: where it is not 0, the cell counts as free.
/// @param blocks all that may hold a cell that counts; those that hold none are cleared.
/// @throws std::invalid_argument for a `left_out` or `blocks` of another size.
std::vector<Component> FindComponents(const OccupancyGrid& occupancy,
                                      std::span<const std::uint8_t> left_out, SearchBlocks* blocks);
std::vector<Component> FindComponents(const OccupancyGrid& occupancy,
                                      std::span<const std::uint8_t> left_out);
std::vector<Component> FindComponents(const OccupancyGrid& occupancy);

/// These cells as a component, whether or not they hang together.
/// @param cells ascending, not empty.
Component MakeComponent(std::vector<std::size_t> cells, const GridSpec& grid);

/// The component alone, in a grid that fits its box, in W.
OccupancyGrid CutOut(const Component& component, const GridSpec& grid);

}  // namespace sidestep::sdf
