#pragma once

#include <Eigen/Geometry>

namespace sidestep {

/// The pose X_AB of frame B in frame A: the rotation R_AB and the position p_AB of B's origin,
/// measured from A's origin and expressed in A, in metres. A value: copy it, never share it.
class Pose {
 public:
  Pose() = default;  // the identity
  /// Normalises R_AB. @throws std::invalid_argument if R_AB is zero or anything is not finite.
  Pose(const Eigen::Quaterniond& R_AB, const Eigen::Vector3d& p_AB);

  /// A pure translation.
  static Pose Translation(const Eigen::Vector3d& p_AB);
  /// From roll, pitch, yaw [rad]: R_AB = Rz(yaw) Ry(pitch) Rx(roll), and a position [m].
  static Pose FromRollPitchYaw(const Eigen::Vector3d& rpy_rad, const Eigen::Vector3d& p_AB);

  Pose Inverse() const;                                             // X_BA
  Pose operator*(const Pose& X_BC) const;                           // X_AC
  Eigen::Vector3d operator*(const Eigen::Vector3d& p_BQ) const;     // p_AQ
  Eigen::Vector3d Rotate(const Eigen::Vector3d& v_B) const;         // the same vector, in A
  Eigen::Vector3d RotateInverse(const Eigen::Vector3d& v_A) const;  // the same vector, in B

  const Eigen::Quaterniond& rotation() const { return R_AB_; }
  const Eigen::Vector3d& translation() const { return p_AB_; }

 private:
  Eigen::Quaterniond R_AB_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_AB_ = Eigen::Vector3d::Zero();
};

}  // namespace sidestep
