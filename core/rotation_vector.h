#pragma once

#include <Eigen/Geometry>

namespace sidestep {

/// The rotation by |v| about v [rad]; none for zero.
inline Eigen::Quaterniond RotationBy(const Eigen::Vector3d& vector_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(vector_rad.norm(), vector_rad.stableNormalized()));
}

/// Its inverse, of at most pi.
inline Eigen::Vector3d RotationVector(const Eigen::Quaterniond& R) {
  const Eigen::AngleAxisd turn(R.w() < 0 ? Eigen::Quaterniond(-R.coeffs()) : R);
  return turn.angle() * turn.axis();
}

}  // namespace sidestep
