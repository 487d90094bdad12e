#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "core/grid.h"
#include "sdf/map/distance_transform.h"
#include "sdf/map/sdf_grid.h"

namespace sidestep {

struct DistanceTransformOptions {
  DistanceConvention convention = DistanceConvention::kSurface;
  /// Distances are exact up to this [m] and clamped to +- this beyond; > 0. Small values are
  /// faster: up to 11 (kSurface) or 15 (kBwdist) cells fit lanes of 8 bits.
  double max_distance_m = std::numeric_limits<double>::infinity();
  int num_threads = 1;    ///< >= 1; the result does not depend on it
  int min_lane_bits = 8;  ///< 8, 16 or 32: use no narrower lanes; the result does not depend on it
};

/// ComputeSignedDistance, many times as fast: the same bits, for any shape of grid.
///
/// SIMD of the best instruction set that the machine has, and the same bits with all of them. An
/// object keeps its memory from call to call: a call on a grid no larger than an earlier one
/// allocates nothing (with one thread; the thread pool's own needs aside). Not safe from several
/// threads at once.
///
/// How it works: fast_distance_transform_kernels.h.
class FastDistanceTransform {
 public:
  FastDistanceTransform();
  ~FastDistanceTransform();
  FastDistanceTransform(FastDistanceTransform&&) noexcept;
  FastDistanceTransform& operator=(FastDistanceTransform&&) noexcept;

  /// The signed distance of each cell [m] in the order of GridSpec::Index.
  /// @throws std::invalid_argument as ComputeSignedDistance, and for options out of range.
  void Compute(const OccupancyGrid& occupancy, const DistanceTransformOptions& options,
               std::vector<float>& distance_m);

  SdfGrid Compute(const OccupancyGrid& occupancy, const DistanceTransformOptions& options = {});

 private:
  class Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace sidestep
