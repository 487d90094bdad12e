#pragma once

#include <vector>

#include "sidestep/import/cover_sphere.h"

namespace sidestep::imports {

/// The volume of the union of spheres [m^3], to about 1e-4 of it: the area of the union of circles
/// is exact in each of `num_slices` slices.
double UnionVolume_m3(const std::vector<CoverSphere>& spheres, int num_slices = 400);

}  // namespace sidestep::imports
