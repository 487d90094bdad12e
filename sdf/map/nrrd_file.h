#pragma once

#include <string>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// Writes a grid as NRRD with its place in space (raw, little-endian, x fastest): ParaView, 3D
/// Slicer and ITK open it, and `numpy.fromfile` reads what follows the first empty line.
/// Format: http://teem.sourceforge.net/nrrd/format.html
/// @throws InputError if the file cannot be written.
void WriteNrrd(const SdfGrid& field, const std::string& path);            // float, metres
void WriteNrrd(const OccupancyGrid& occupancy, const std::string& path);  // uint8, 0 or 1

}  // namespace sidestep::sdf
