#include "sidestep/sdf/map/occupancy_from_scan.h"

#include <algorithm>
#include <cstring>

namespace sidestep::sdf {

ScanRasteriser::ScanRasteriser(const GridSpec& grid_W) {
  CheckGridSpec(grid_W);
  occupancy_ = OccupancyGrid(grid_W);
}

const OccupancyGrid& ScanRasteriser::Fill(const Scan& scan) {
  const Eigen::Index num_points = scan.p_CP.cols();
  const Eigen::Index num_same = CountKept(scan);
  if (num_same > 0 && num_same == kept_p_CP_.cols()) {
    for (const std::size_t cell : passing_) occupancy_.cells[cell] = 0;
    passing_ = Place(scan, num_same, num_points);
    return occupancy_;
  }
  // Other points than expected. What they share with the earlier ones is worth keeping unless it is
  // next to nothing; then all are, until the next scan tells.
  const Eigen::Index num_kept = 16 * num_same > num_points ? num_same : num_points;
  std::fill(occupancy_.cells.begin(), occupancy_.cells.end(), std::uint8_t{0});
  Place(scan, 0, num_kept);
  passing_ = Place(scan, num_kept, num_points);
  X_WC_ = scan.X_WC;
  kept_p_CP_ = scan.p_CP.leftCols(num_kept);
  return occupancy_;
}

Eigen::Index ScanRasteriser::CountKept(const Scan& scan) const {
  if (scan.X_WC.rotation().coeffs() != X_WC_.rotation().coeffs() ||
      scan.X_WC.translation() != X_WC_.translation()) {
    return 0;
  }
  const Eigen::Index longest = std::min(kept_p_CP_.cols(), scan.p_CP.cols());
  // By bytes, so that equal points that are not a number count as equal.
  const auto differ = [&](Eigen::Index first, Eigen::Index count) {
    return std::memcmp(scan.p_CP.data() + 3 * first, kept_p_CP_.data() + 3 * first,
                       static_cast<std::size_t>(3 * count) * sizeof(double)) != 0;
  };
  if (longest == 0 || !differ(0, longest)) return longest;
  Eigen::Index same = 0;
  while (!differ(same, 1)) ++same;
  return same;
}

std::vector<std::size_t> ScanRasteriser::Place(const Scan& scan, Eigen::Index begin,
                                               Eigen::Index end) {
  std::vector<std::size_t> filled;
  const GridSpec& grid_W = occupancy_.spec;
  const Eigen::Matrix3d R_WC = scan.X_WC.rotation().toRotationMatrix();
  const auto [nx, ny, nz] = grid_W.size;
  for (Eigen::Index n = begin; n < end; ++n) {
    const Eigen::Vector3d p_WP = scan.X_WC.translation() + R_WC * scan.p_CP.col(n);
    // GridSpec::CellOf, without its care for points outside: those go, and with them what is not a
    // number.
    const Eigen::Vector3d u = ((p_WP - grid_W.first_center_m) / grid_W.cell_m).array() + 0.5;
    if (!(u.x() >= 0 && u.x() < nx && u.y() >= 0 && u.y() < ny && u.z() >= 0 && u.z() < nz)) {
      continue;
    }
    const std::size_t cell =
        grid_W.Index(static_cast<int>(u.x()), static_cast<int>(u.y()), static_cast<int>(u.z()));
    if (occupancy_.cells[cell] != 0) continue;
    occupancy_.cells[cell] = 1;
    filled.push_back(cell);
  }
  return filled;
}

}  // namespace sidestep::sdf
