#include "sidestep/core/pose.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace sidestep {

Pose::Pose(const Eigen::Quaterniond& R_AB, const Eigen::Vector3d& p_AB) : R_AB_(R_AB), p_AB_(p_AB) {
  const double largest = R_AB.coeffs().cwiseAbs().maxCoeff();
  if (!(largest > 0) || !R_AB.coeffs().allFinite() || !p_AB.allFinite()) {
    throw std::invalid_argument("Pose: the rotation must not be zero, every number finite");
  }
  constexpr double kSquarable =
      1e150;  // squares of larger numbers overflow, of smaller ones vanish
  if (largest > kSquarable || largest < 1 / kSquarable) R_AB_.coeffs() /= largest;
  const double norm = R_AB_.norm();
  // What is normalised already keeps its bits, so that a pose survives being stored and read back.
  constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();
  if (std::abs(norm - 1) > kRounding) R_AB_.coeffs() /= norm;
}

Pose Pose::Translation(const Eigen::Vector3d& p_AB) {
  return Pose(Eigen::Quaterniond::Identity(), p_AB);
}

Pose Pose::FromRollPitchYaw(const Eigen::Vector3d& rpy_rad, const Eigen::Vector3d& p_AB) {
  if (rpy_rad.isZero(0)) return Translation(p_AB);  // mostly, and thousands of times a second
  return Pose(Eigen::AngleAxisd(rpy_rad.z(), Eigen::Vector3d::UnitZ()) *
                  Eigen::AngleAxisd(rpy_rad.y(), Eigen::Vector3d::UnitY()) *
                  Eigen::AngleAxisd(rpy_rad.x(), Eigen::Vector3d::UnitX()),
              p_AB);
}

Pose Pose::Inverse() const {
  const Eigen::Quaterniond R_BA = R_AB_.conjugate();
  return Pose(R_BA, -(R_BA * p_AB_));
}

Pose Pose::operator*(const Pose& X_BC) const {
  return Pose(R_AB_ * X_BC.R_AB_, p_AB_ + R_AB_ * X_BC.p_AB_);
}

Eigen::Vector3d Pose::operator*(const Eigen::Vector3d& p_BQ) const { return p_AB_ + R_AB_ * p_BQ; }

Eigen::Vector3d Pose::Rotate(const Eigen::Vector3d& v_B) const { return R_AB_ * v_B; }

Eigen::Vector3d Pose::RotateInverse(const Eigen::Vector3d& v_A) const {
  return R_AB_.conjugate() * v_A;
}

}  // namespace sidestep
