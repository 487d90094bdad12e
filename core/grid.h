#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sidestep {

/// A regular grid of cubic cells, aligned with its frame's axes. Cell (i, j, k) is the cube of edge
/// `cell_m` around its centre p_center_m(0,0,0) + cell_m (i, j, k). In memory x runs fastest, then
/// y, then z.
struct GridSpec {
  Eigen::Vector3d first_center_m = Eigen::Vector3d::Zero();  ///< centre of cell (0, 0, 0)
  double cell_m = 0;                                         ///< > 0
  std::array<int, 3> size = {0, 0, 0};                       ///< cells along x, y, z, each >= 1

  std::size_t num_cells() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) *
           static_cast<std::size_t>(size[2]);
  }
  std::size_t Index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(j) +
                static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k));
  }
  bool Contains(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < size[0] && j < size[1] && k < size[2];
  }
  Eigen::Vector3d Center(int i, int j, int k) const {
    return first_center_m + cell_m * Eigen::Vector3d(i, j, k);
  }
  /// Which cell has this Index.
  std::array<int, 3> CellAt(std::size_t index) const {
    const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
    return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
            static_cast<int>(index / nx / ny)};
  }
  Eigen::Vector3d CenterOf(std::size_t index) const {
    const auto [i, j, k] = CellAt(index);
    return Center(i, j, k);
  }
  /// The cell that holds a point; it may lie outside the grid. Cells are half-open: a point on the
  /// face between two cells belongs to the upper one.
  std::array<int, 3> CellOf(const Eigen::Vector3d& p) const;

  bool operator==(const GridSpec&) const = default;
};

/// @throws std::invalid_argument unless the cell is > 0, every size >= 1 and all finite.
void CheckGridSpec(const GridSpec& spec);

/// Which cells are filled: 1 filled, 0 free; in the order of GridSpec::Index.
struct OccupancyGrid {
  GridSpec spec;
  std::vector<std::uint8_t> cells;

  OccupancyGrid() = default;
  explicit OccupancyGrid(const GridSpec& grid) : spec(grid), cells(grid.num_cells(), 0) {}
  bool At(int i, int j, int k) const { return cells[spec.Index(i, j, k)] != 0; }
  std::size_t CountFilled() const;
};

}  // namespace sidestep
