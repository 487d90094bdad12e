#pragma once

#include "sidestep/core/grid.h"
#include "sidestep/core/shape.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// How many free cells an object's grid needs on each side, so that its field has reached
/// `margin_m` wherever it ends: ceil(margin / cell), and one more because interpolation next to the
/// border looks one cell outwards. With fewer, a composite field jumps at the borders of its
/// objects' grids.
int PaddingCells(double margin_m, double cell_m);

/// The field of a shape given as cells in its own frame O, padded for `margin_m` > 0. The same cell
/// edge; the padding counts as free.
/// @throws std::invalid_argument as ComputeSignedDistance, or for a margin that is not > 0.
SdfGrid MakeObjectField(const OccupancyGrid& shape_O, double margin_m,
                        DistanceConvention convention = DistanceConvention::kSurface);

/// What a field may have at most, for its half a gigabyte of memory.
inline constexpr double kMostShapeFieldCells = 512.0 * 512 * 512;

/// How many cells MakeShapeField makes of a shape; they may be beyond any integer.
double ShapeFieldCells(const Shape& shape, double cell_m, double margin_m);

/// The exact distances of an ideal shape, sampled at cells of its own frame O (one has its centre
/// in the origin), padded for `margin_m` > 0. Unlike a field made from occupied cells it knows the
/// surface to better than half a cell.
/// @throws std::invalid_argument unless cell and margin are > 0 and there are at most
/// kMostShapeFieldCells.
SdfGrid MakeShapeField(const Shape& shape, double cell_m, double margin_m);

}  // namespace sidestep::sdf
