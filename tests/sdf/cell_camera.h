#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/map/cells_on_line.h"

namespace sidestep::sdf {

/// A perfect camera in a world of cells: it sees a cell if nothing filled lies on the straight way
/// to its middle, and remembers of the others what it saw last.
class CellCamera {
 public:
  CellCamera(const GridSpec& grid, const Eigen::Vector3d& p_W)
      : p_W_(p_W), map_(grid), seen_(grid.num_cells(), 0) {}

  void Look(const OccupancyGrid& truth) {
    for (std::size_t cell = 0; cell < seen_.size(); ++cell) {
      bool is_hidden = false;
      VisitCellsOnLine(truth.spec, p_W_, truth.spec.CenterOf(cell),
                       [&](std::size_t other, double, double) {
                         if (other != cell) is_hidden |= truth.cells[other] != 0;
                         return other != cell && !is_hidden;
                       });
      seen_[cell] = is_hidden ? 0 : 1;
      if (seen_[cell] != 0) map_.cells[cell] = truth.cells[cell];
    }
  }

  const OccupancyGrid& map() const { return map_; }
  const std::vector<std::uint8_t>& seen() const { return seen_; }

 private:
  Eigen::Vector3d p_W_;
  OccupancyGrid map_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace sidestep::sdf
