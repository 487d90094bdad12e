#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>

#include "sidestep/core/pose.h"

namespace sidestep::robot {

/// What a joint lets its link do. Positions, speeds, ... of a revolute joint are in rad, of a
/// prismatic one in m.
enum class JointKind { kRevolute, kPrismatic, kFixed };

/// Limits of one joint: of a revolute one in rad, rad/s, rad/s^2, rad/s^3, N m, N m/s, of a
/// prismatic one in m, m/s, m/s^2, m/s^3, N, N/s. Infinite where robot.yaml gives none.
struct JointLimits {
  double q_min = 0, q_max = 0;
  double v_max = 0;
  double a_max = 0;
  double jerk_max = 0;
  double torque_max = 0;
  double torque_rate_max = 0;
};

/// One row of a classic (distal) Denavit-Hartenberg table: A_i = Rz(q_i + theta) Tz(d) Tx(a)
/// Rx(alpha); of a prismatic joint q_i is added to d instead.
struct DhRow {
  double a_m = 0, alpha_rad = 0, d_m = 0, theta_rad = 0;
};

/// A joint and the link that it carries. The joint's frame J stands at X_PJ in the frame P of the
/// parent link. By `axis_J` it turns or slides the link, whose frame L is J's at q = 0; or, by
/// `dh`, it is Rz(q) (or Tz(q)) and L is the frame after the row.
struct Joint {
  std::string name;
  std::string link;
  JointKind kind = JointKind::kRevolute;
  int parent = -1;  ///< the joint whose link is the parent, an earlier one; -1 for the base
  Pose X_PJ;
  Eigen::Vector3d axis_J = Eigen::Vector3d::UnitZ();  ///< of length 1
  std::optional<DhRow> dh;
  /// Which number of a configuration moves it; -1 if it is fixed.
  int coordinate = -1;
  /// Its position is multiplier * q(coordinate) + offset: 1 and 0 but for a joint that mimics
  /// another.
  double multiplier = 1, offset = 0;
};

/// X_JL of a joint with an axis, at a position [rad, or m of one that slides]; one that is fixed
/// does nothing.
inline Pose MotionOf(JointKind kind, const Eigen::Vector3d& axis_J, double position) {
  switch (kind) {
    case JointKind::kRevolute:
      return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(position, axis_J)), Eigen::Vector3d::Zero());
    case JointKind::kPrismatic:
      return Pose::Translation(position * axis_J);
    case JointKind::kFixed:
      break;
  }
  return Pose();
}

}  // namespace sidestep::robot
