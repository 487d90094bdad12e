#include "sidestep/core/grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sidestep {

std::array<int, 3> GridSpec::CellOf(const Eigen::Vector3d& p) const {
  std::array<int, 3> cell;
  for (int a = 0; a < 3; ++a) {
    const double x = std::floor((p(a) - first_center_m(a)) / cell_m + 0.5);
    cell[static_cast<std::size_t>(a)] = static_cast<int>(std::clamp(x, -1e9, 1e9));
  }
  return cell;
}

void CheckGridSpec(const GridSpec& spec) {
  if (!(spec.cell_m > 0) || !std::isfinite(spec.cell_m) || !spec.first_center_m.allFinite() ||
      *std::min_element(spec.size.begin(), spec.size.end()) < 1) {
    throw std::invalid_argument("grid: the cell must be > 0, every size >= 1, all numbers finite");
  }
}

std::size_t OccupancyGrid::CountFilled() const {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [](std::uint8_t c) { return c != 0; }));
}

}  // namespace sidestep
