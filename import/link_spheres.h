#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/robot/arm_description.h"

namespace sidestep::import {

struct LinkSphere {
  Eigen::Vector3d p_LS;
  double radius_m;
};

/// Spheres that hold all solids of a link, and stick out of them by about `tolerance_m` at most,
/// more only where that would take too many: those around the cubes of a coarse grid.
std::vector<LinkSphere> CoverLink(const std::vector<robot::LinkSolid>& solids, double tolerance_m);

}  // namespace sidestep::import
