#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "sidestep/robot/joint.h"

namespace sidestep::robot {

/// One moving joint in the form that is computed: from the frame P of the row before,
/// X_PK = X_PA Rz(theta) Tz(d) Tx(a) Rx(alpha), where the joint's position is added to theta, or to
/// d if it slides. Every joint has this form: X_PA leads to a frame with z along its axis, and one
/// that is no row of a Denavit-Hartenberg table has a = alpha = 0.
struct KinematicRow {
  int parent = -1;        ///< an earlier row; -1: the base
  bool is_moved = false;  ///< whether X_PA is not the identity
  Eigen::Matrix3d R_PA = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_PA = Eigen::Vector3d::Zero();
  bool slides = false;
  double theta_rad = 0, d_m = 0, a_m = 0, cos_alpha = 1, sin_alpha = 0;
  int coordinate = 0;
  double multiplier = 1, offset = 0;

  double PositionOf(const double q) const { return multiplier * q + offset; }
};

/// Where a row's joint and its frame are, in world axes.
struct RowPlace {
  Eigen::Vector3d z_W, p_WJ;  ///< the joint's axis, and a point of it
  Eigen::Matrix3d R_WK;
  Eigen::Vector3d p_WK;
};

/// The frame K of a row from that of its parent. `position` is the joint's own.
inline void PlaceRow(const KinematicRow& row, const Eigen::Matrix3d& R_WP,
                     const Eigen::Vector3d& p_WP, double position, RowPlace& place) {
  Eigen::Matrix3d R = R_WP;
  Eigen::Vector3d p = p_WP;
  if (row.is_moved) {
    p += R * row.p_PA;
    R = R_WP * row.R_PA;
  }
  place.z_W = R.col(2);
  place.p_WJ = p;
  const double theta = row.slides ? row.theta_rad : position + row.theta_rad;
  const double d = row.slides ? position + row.d_m : row.d_m;
  const double c = std::cos(theta), s = std::sin(theta);
  const Eigen::Vector3d x = c * R.col(0) + s * R.col(1);  // after Rz
  const Eigen::Vector3d y = c * R.col(1) - s * R.col(0);
  const Eigen::Vector3d z = R.col(2);
  place.p_WK = p + (d * z + row.a_m * x);
  place.R_WK.col(0) = x;
  place.R_WK.col(1) = row.cos_alpha * y + row.sin_alpha * z;
  place.R_WK.col(2) = row.cos_alpha * z - row.sin_alpha * y;
}

/// A robot with more joints that move, with those that mimic others, is refused.
inline constexpr int kMaxRows = 32;

/// Where all rows of a robot are. Entry 0 is the base, whose R_WK and p_WK say where it stands;
/// entry i + 1 is row i.
struct RowPlaces {
  std::array<RowPlace, kMaxRows + 1> of;

  const RowPlace& operator[](int row) const {
    const int entry = row + 1;
    return of[static_cast<std::size_t>(entry)];
  }
};

/// The forward kinematics of rows, from the base's place, which is given. Allocates nothing.
/// @param q any vector of the robot's number of coordinates.
template <class Vector>
void PlaceRows(const std::vector<KinematicRow>& rows, const Vector& q, RowPlaces& places) {
  std::size_t entry = 0;
  for (const KinematicRow& row : rows) {
    const RowPlace& parent = places[row.parent];
    PlaceRow(row, parent.R_WK, parent.p_WK, row.PositionOf(q(row.coordinate)), places.of[++entry]);
  }
}

/// A link stands still in the frame of a row, or of the base.
struct LinkOnRow {
  int row = -1;
  bool is_moved = false;  ///< whether X_KL is not the identity
  Eigen::Matrix3d R_KL = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_KL = Eigen::Vector3d::Zero();

  /// A point of the link, in the row's frame.
  Eigen::Vector3d OnRow(const Eigen::Vector3d& p_LQ) const {
    return is_moved ? Eigen::Vector3d(p_KL + R_KL * p_LQ) : p_LQ;
  }
};

/// A tree of joints as rows: what moves, in order, with all that is fixed folded in.
class Kinematics {
 public:
  Kinematics() = default;
  /// @param joints parents before children.
  explicit Kinematics(const std::vector<Joint>& joints);

  const std::vector<KinematicRow>& rows() const { return rows_; }
  /// @param link the joint that carries it; -1: the base.
  const LinkOnRow& link(int link) const {
    const int entry = link + 1;
    return links_[static_cast<std::size_t>(entry)];
  }
  /// The rows that move what stands on `row`, from the base on; none for -1.
  const std::vector<int>& movers(int row) const {
    const int entry = row + 1;
    return movers_[static_cast<std::size_t>(entry)];
  }

 private:
  std::vector<KinematicRow> rows_;
  std::vector<LinkOnRow> links_;
  std::vector<std::vector<int>> movers_;
};

}  // namespace sidestep::robot
