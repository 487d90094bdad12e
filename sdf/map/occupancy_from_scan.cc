#include "sdf/map/occupancy_from_scan.h"

namespace sidestep {

OccupancyGrid FillFromScan(const Scan& scan, const GridSpec& grid_W) {
  CheckGridSpec(grid_W);
  OccupancyGrid occupancy(grid_W);
  const Eigen::Matrix3d R_WC = scan.X_WC.rotation().toRotationMatrix();
  for (Eigen::Index n = 0; n < scan.p_CP.cols(); ++n) {
    const Eigen::Vector3d p_WP = scan.X_WC.translation() + R_WC * scan.p_CP.col(n);
    if (!p_WP.allFinite()) continue;
    const auto [i, j, k] = grid_W.CellOf(p_WP);
    if (grid_W.Contains(i, j, k)) occupancy.cells[grid_W.Index(i, j, k)] = 1;
  }
  return occupancy;
}

}  // namespace sidestep
