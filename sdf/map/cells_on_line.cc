#include "sidestep/sdf/map/cells_on_line.h"

namespace sidestep::sdf {

std::array<double, 2> PartInGrid(const GridSpec& grid, const Eigen::Vector3d& p_WStart,
                                 const Eigen::Vector3d& way_W) {
  double first = 0, last = 1;
  for (int a = 0; a < 3; ++a) {
    const double lower = grid.first_center_m(a) - grid.cell_m / 2;
    const double upper = lower + grid.cell_m * grid.size[static_cast<std::size_t>(a)];
    if (way_W(a) == 0) {
      if (p_WStart(a) < lower || p_WStart(a) >= upper) return {1, 0};
      continue;
    }
    const double to_lower = (lower - p_WStart(a)) / way_W(a);
    const double to_upper = (upper - p_WStart(a)) / way_W(a);
    first = std::max(first, std::min(to_lower, to_upper));
    last = std::min(last, std::max(to_lower, to_upper));
  }
  return {first, last};
}

}  // namespace sidestep::sdf
