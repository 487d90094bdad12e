#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/import/cover_sphere.h"

namespace sidestep::imports {

/// Moves spheres, and makes them smaller or larger, so that their union gets as small as it may
/// while no point sticks out of it by more than `cover_m`; leaves out those that no point needs.
///
/// By gradient descent with a penalty that grows (steps of Adam: D. Kingma, J. Ba, ICLR 2015). The
/// gradient of the volume of a union is its free surface: of a sphere, the part outside all others.
/// @param spheres at least one.
/// @param steps of the descent.
std::vector<CoverSphere> ShrinkCover(const Eigen::Matrix3Xd& points_m, double cover_m,
                                     std::vector<CoverSphere> spheres, int steps,
                                     double first_step = 0.03);

/// Makes each sphere as small as the points allow that only it covers, one after the other, and
/// leaves out those without such points.
std::vector<CoverSphere> Tighten(const Eigen::Matrix3Xd& points_m, double cover_m,
                                 const std::vector<CoverSphere>& spheres);

}  // namespace sidestep::imports
