#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"

namespace sidestep::robot {

/// Limits of one joint (rad, rad/s, rad/s^2, rad/s^3, N m, N m/s). Infinite where robot.yaml gives
/// none.
struct JointLimits {
  double q_min = 0, q_max = 0;
  double v_max = 0;
  double a_max = 0;
  double jerk_max = 0;
  double torque_max = 0;
  double torque_rate_max = 0;
};

/// One row of a classic (distal) Denavit-Hartenberg table: A_i = Rz(q_i + theta) Tz(d) Tx(a)
/// Rx(alpha).
struct DhRow {
  double a_m = 0, alpha_rad = 0, d_m = 0, theta_rad = 0;
};

/// A collision sphere, fixed in the frame after DH row `link` (0-based).
struct CollisionSphere {
  int link = 0;
  Eigen::Vector3d p_LS = Eigen::Vector3d::Zero();  ///< [m]
  double radius_m = 0;
};

/// A capsule that covers a part of the arm, fixed in the frame after DH row `link`, or in the base
/// frame B for link -1: the segment from A to B, grown by the radius.
struct CollisionCapsule {
  int link = 0;
  Eigen::Vector3d p_LA = Eigen::Vector3d::Zero(), p_LB = Eigen::Vector3d::Zero();  ///< [m]
  double radius_m = 0;
};

/// What the tool, the frame after the last row, must not exceed; infinite where nothing is known.
struct ToolLimits {
  double a_max = std::numeric_limits<double>::infinity();     ///< [m/s^2] the robot's own limit
  double a_reflex = std::numeric_limits<double>::infinity();  ///< above it a reflex was reported
};

/// Two links (0-based DH rows, first < second) that could touch each other.
struct LinkPair {
  int first = 0, second = 0;
};

/// Where the spheres are for one q. S spheres, n joints.
struct SphereCenters {
  Eigen::Matrix3Xd p_WS;  ///< [m] 3 x S
  Eigen::MatrixXd Jq;     ///< 3S x n, d p_WS / d q; empty unless asked for
};

/// A serial arm as data: joints, limits, collision spheres, named configurations. Immutable; safe
/// from many threads. Frames: W the world, B the base (X_WB is fixed), L_i the frame after DH row
/// i.
class RobotModel {
 public:
  /// Reads `<models_dir>/<name>/robot.yaml` (its keys: docs/robots.md).
  /// @throws InputError FILE:LINE: KEY: WHY; for a name without such a file, the known names.
  static RobotModel Load(const std::string& models_dir, const std::string& name, const Pose& X_WB);
  /// The same from a file of any name.
  static RobotModel FromFile(const std::string& path, const Pose& X_WB);

  /// The robots there are: the folders of `models_dir` that hold a robot.yaml, sorted.
  static std::vector<std::string> ListNames(const std::string& models_dir);

  /// What ComputeSphereCenters has room for; longer arms are refused.
  static constexpr int kMaxJoints = 16;
  /// More are refused.
  static constexpr std::size_t kMaxCapsules = 32;

  const std::string& name() const { return name_; }
  const std::string& file() const { return file_; }  ///< where it was read
  /// The line there of what only other modules can judge, by its path (`joints[2].dh`,
  /// `joints[2].limits.q_min_rad`, `mount.links`, ...); 1 for any other.
  int LineOf(const std::string& key) const;
  const Pose& X_WB() const { return X_WB_; }
  int num_joints() const { return static_cast<int>(limits_.size()); }
  int num_spheres() const { return static_cast<int>(spheres_.size()); }
  const std::vector<std::string>& joint_names() const { return joint_names_; }
  const std::vector<DhRow>& dh() const { return dh_; }
  const std::vector<JointLimits>& limits() const { return limits_; }
  const ToolLimits& tool_limits() const { return tool_limits_; }
  const std::vector<CollisionSphere>& spheres() const { return spheres_; }
  const Eigen::VectorXd& sphere_radii_m() const { return radii_m_; }  ///< shape S
  double largest_sphere_radius_m() const { return radii_m_.maxCoeff(); }
  /// What covers the whole arm, for safety (planners see the spheres); empty if robot.yaml names
  /// none.
  const std::vector<CollisionCapsule>& capsules() const { return capsules_; }
  /// Named joint positions, each within the position limits.
  const std::map<std::string, Eigen::VectorXd>& configurations() const { return configurations_; }

  /// Spheres that obstacle costs and start checks leave out, because robot.yaml says that they
  /// overlap what the robot is mounted on. 0-based, ascending.
  const std::vector<int>& mount_spheres() const { return mount_spheres_; }
  /// Links (names of MJCF bodies) that may touch what the robot is mounted on.
  const std::vector<std::string>& mount_links() const { return mount_links_; }
  /// Pairs of links that planners keep apart; each link has spheres. Empty if robot.yaml names
  /// none.
  const std::vector<LinkPair>& self_collision() const { return self_collision_; }
  /// Joint impedance gains of the simulated controller, shape n: N m/rad and N m s/rad.
  const Eigen::VectorXd& stiffness() const { return stiffness_; }
  const Eigen::VectorXd& damping() const { return damping_; }

  /// X_WL of the frame after each DH row, for q of shape n.
  /// @throws std::invalid_argument for a q of the wrong shape.
  std::vector<Pose> ComputeLinkPoses(const Eigen::VectorXd& q) const;

  /// Centres of all spheres and, if asked, their Jacobian: column j of sphere s is
  /// z_j x (p_s - o_j) with the axis z_j and origin o_j of joint j, zero for joints beyond the
  /// sphere's link. No allocation beyond the result.
  /// @throws std::invalid_argument for a q of the wrong shape.
  SphereCenters ComputeSphereCenters(const Eigen::VectorXd& q, bool with_jacobian) const;

 private:
  struct Chain;  // where every joint axis and link frame is for one q
  Chain ComputeChain(const Eigen::VectorXd& q) const;

  std::string name_, file_;
  std::map<std::string, int> lines_;
  Pose X_WB_;
  std::vector<std::string> joint_names_;
  std::vector<DhRow> dh_;
  std::vector<double> cos_alpha_, sin_alpha_;  // of dh_: half of all trigonometry
  std::vector<JointLimits> limits_;
  ToolLimits tool_limits_;
  std::vector<CollisionSphere> spheres_;
  std::vector<CollisionCapsule> capsules_;
  Eigen::VectorXd radii_m_;
  std::map<std::string, Eigen::VectorXd> configurations_;
  std::vector<int> mount_spheres_;
  std::vector<std::string> mount_links_;
  std::vector<LinkPair> self_collision_;
  Eigen::VectorXd stiffness_, damping_;
};

}  // namespace sidestep::robot
