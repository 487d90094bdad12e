#pragma once

#include <Eigen/Core>
#include <string>

namespace sidestep::imports {

/// Why a matrix is no inertia of a solid: not positive definite, or one of its principal moments is
/// more than the sum of the others. Empty if it is one.
std::string WhyNoInertia(const Eigen::Matrix3d& I);

/// The inertia that is meant: with the same axes, moments too small raised to 1e-6 of the greatest
/// (at least 1e-9 kg m^2), and where two are less than the third, both raised by half of what is
/// missing.
Eigen::Matrix3d RepairedInertia(const Eigen::Matrix3d& I);

}  // namespace sidestep::imports
