#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sidestep/core/grid.h"

namespace sidestep::bench {

/// A distance transform under test: signed distances in cells, between centres, of a grid whose
/// cells have the edge 1. Returns the CPU seconds it took, without what its caller's formats cost.
using TimedTransform = std::function<double(const OccupancyGrid& grid, const std::string& variant,
                                            std::vector<float>& distance)>;

/// Serves compare.py, a line at a time: "grid FILE N" reads N^3 bytes, "run VARIANT" transforms
/// them and answers with the CPU milliseconds, "save FILE" writes the latest result as floats.
/// @return the exit code of the process.
int ServeTransform(const TimedTransform& transform);

}  // namespace sidestep::bench
