#pragma once

#include <vector>

#include "core/time.h"
#include "sdf/composite_field.h"
#include "sdf/map/sdf_grid.h"

namespace sidestep {

/// The composite field as a grid, for one time: a copy of the static grid, lowered by each object's
/// field where that reaches, with the object moved to the nearest whole cell. It is what the
/// authors compute for each predicted step; here it serves comparison and export, since
/// CompositeField is cheaper and rounds nothing. Not clamped, and without growth.
///
/// Source: Finean, Merkt & Havoutis (ICAPS 2021), algorithm 2.
///
/// @throws std::invalid_argument for an object with another cell edge, or turned against W.
SdfGrid ComposeDense(const SdfGrid& static_W, const std::vector<MovingField>& objects,
                     EpisodeTime t);

}  // namespace sidestep
