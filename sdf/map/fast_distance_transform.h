#pragma once

#include <limits>
#include <memory>
#include <span>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// Only the first two change what is computed.
struct DistanceTransformOptions {
  DistanceConvention convention = DistanceConvention::kSurface;
  /// [m] > 0. Distances are exact up to this and clamped to +- this beyond. A few cells are
  /// computed faster than many: up to 13 (kSurface) or 15 (kBwdist), lanes of 8 bits suffice.
  double max_distance_m = std::numeric_limits<double>::infinity();
  int num_threads = 1;    ///< >= 1
  int min_lane_bits = 8;  ///< 8, 16 or 32: no narrower lanes are tried
};

/// ComputeSignedDistance, many times as fast and to the last bit the same, for grids of any shape.
///
/// It uses the best instruction set that the machine has; the result is the same with each. An
/// object keeps its memory: with one thread, a call for a grid no larger than an earlier one
/// allocates nothing. One object serves one call at a time.
///
/// fast_distance_transform_kernels.h says how it works.
class FastDistanceTransform {
 public:
  FastDistanceTransform();
  ~FastDistanceTransform();
  FastDistanceTransform(FastDistanceTransform&&) noexcept;
  FastDistanceTransform& operator=(FastDistanceTransform&&) noexcept;

  /// @param distance_m [m] receives the signed distance of each cell, in the order of
  /// GridSpec::Index. Grids too large for the caches are written faster if it is aligned to 64
  /// bytes and the rows are multiples of them.
  /// @throws std::invalid_argument as CheckTransformInput, for options out of range, or for a
  /// `distance_m` of another size.
  void Compute(const OccupancyGrid& occupancy, const DistanceTransformOptions& options,
               std::span<float> distance_m);

  /// The same as a field.
  SdfGrid Compute(const OccupancyGrid& occupancy, const DistanceTransformOptions& options = {});

 private:
  class Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace sidestep::sdf
