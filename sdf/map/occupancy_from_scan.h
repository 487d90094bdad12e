#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"

namespace sidestep::sdf {

/// Fills the cells that hold at least one point of a scan. Points outside the grid are left out,
/// and so are points that are not finite (a camera's pixels without depth).
///
/// A sensor that knows what rests reports that first, in the same numbers each time. So the points
/// that begin a scan as they began earlier ones are compared, and only the others are placed again.
class ScanRasteriser {
 public:
  /// @throws std::invalid_argument for a bad grid.
  explicit ScanRasteriser(const GridSpec& grid_W);

  /// What is filled by this scan alone. Valid until the next call.
  const OccupancyGrid& Fill(const Scan& scan);
  /// All cells that the latest scan may have changed; none: any.
  const std::optional<std::vector<std::size_t>>& may_differ() const { return may_differ_; }

 private:
  // How many of the kept points begin the scan.
  Eigen::Index CountKept(const Scan& scan) const;
  // Fills the cells of the points begin, begin + 1, ..., end - 1. Returns those that were free.
  std::vector<std::size_t> Place(const Scan& scan, Eigen::Index begin, Eigen::Index end);

  OccupancyGrid occupancy_;
  Pose X_WC_;                   // of the kept points
  Eigen::Matrix3Xd kept_p_CP_;  // those that scans are expected to begin with
  std::optional<std::vector<std::size_t>> may_differ_;
  std::vector<std::size_t> passing_;  // the cells that only later points of the latest scan fill
};

}  // namespace sidestep::sdf
