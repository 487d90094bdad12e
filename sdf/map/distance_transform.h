#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// Between what a signed distance is measured.
enum class DistanceConvention {
  /// From a cell's centre to the solid made of the filled cells' cubes; inside, to the space made
  /// of the free cells' cubes. Zero on the surface of the cubes, where a free and a filled
  /// neighbour stand at +1/2 and -1/2 cell.
  kSurface,
  /// From centre to centre, as MATLAB's bwdist and thus Finean et al. (ICAPS 2021) and GPMP2:
  /// neighbours across a surface stand at +1 and -1 cell, so that free space looks half a cell
  /// larger than it is, and slopes are 2 at the surface.
  kBwdist,
};

/// What ComputeSignedDistance answers where there is no surface at all [m]: positive in an empty
/// grid, negative in a full one. The authors' value for an empty map.
inline constexpr float kNoSurfaceDistance_m = 1000.0F;

/// What ComputeSquaredDistance answers where there is no cell of the other kind.
inline constexpr std::int32_t kNoOtherCell = std::numeric_limits<std::int32_t>::max();

/// What every transform asks of its input.
/// @throws std::invalid_argument for a bad spec, a number of cells that does not fit it, or a grid
/// whose squared diagonal exceeds 2^28 cells (over 9000 cells along each axis).
void CheckTransformInput(const OccupancyGrid& occupancy);

/// The exact Euclidean distance transform of both kinds of cells in one pass: for each cell, the
/// square of the distance to the nearest cell of the other kind (filled for a free cell, free for a
/// filled one), in half cells. Cells outside the grid do not count as either. Linear in the number
/// of cells.
///
/// The distance is separable, so three passes of one-dimensional lower envelopes give it:
/// P. Felzenszwalb, D. Huttenlocher, "Distance Transforms of Sampled Functions", Theory of
/// Computing 8:415-428, 2012; in integers as A. Meijster, J. Roerdink, W. Hesselink, "A General
/// Algorithm for Computing Distance Transforms in Linear Time", 2000.
///
/// @throws as CheckTransformInput.
std::vector<std::int32_t> ComputeSquaredDistance(const OccupancyGrid& occupancy,
                                                 DistanceConvention convention);

/// The signed distance in metres: positive in free cells, negative in filled ones.
/// @throws as CheckTransformInput.
SdfGrid ComputeSignedDistance(const OccupancyGrid& occupancy,
                              DistanceConvention convention = DistanceConvention::kSurface);

}  // namespace sidestep::sdf
