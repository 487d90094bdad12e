#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/field_audit.h"
#include "sidestep/render/font.h"
#include "sidestep/render/image.h"

namespace sidestep::cli {

/// A picture of how far a field is from the truth, in the horizontal layer of cells that holds a
/// place: seen from above, x to the right, y upwards, in metres. Hotter is further off, up to the
/// largest difference in the layer's free space. What is truly solid is grey, what the field holds
/// for solid has a blue rim, the place a green one. `title` goes above it, line by line, a legend
/// below.
render::Image DrawHeatSlice(const bench::AuditGrids& grids, const Eigen::Vector3d& p_W,
                            const std::vector<std::string>& title, const render::Font& font);

}  // namespace sidestep::cli
