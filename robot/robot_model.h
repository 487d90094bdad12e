#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/model_folders.h"
#include "sidestep/core/pose.h"
#include "sidestep/robot/joint.h"
#include "sidestep/robot/kinematics.h"

namespace sidestep::robot {

/// A collision sphere, fixed in the frame of the link that joint `link` carries, or in the base
/// frame B for link -1.
struct CollisionSphere {
  int link = 0;
  Eigen::Vector3d p_LS = Eigen::Vector3d::Zero();  ///< [m]
  double radius_m = 0;
};

/// A capsule that covers a part of the arm, fixed in the frame of a link as a sphere is: the
/// segment from A to B, grown by the radius.
struct CollisionCapsule {
  int link = 0;
  Eigen::Vector3d p_LA = Eigen::Vector3d::Zero(), p_LB = Eigen::Vector3d::Zero();  ///< [m]
  double radius_m = 0;
};

/// What the tool frame must not exceed; infinite where nothing is known.
struct ToolLimits {
  double a_max = std::numeric_limits<double>::infinity();     ///< [m/s^2] the robot's own limit
  double a_reflex = std::numeric_limits<double>::infinity();  ///< above it a reflex was reported
};

/// Two links, by the joints that carry them (-1: the base; first < second), that could touch each
/// other.
struct LinkPair {
  int first = 0, second = 0;
};

/// Where the spheres are for one q. S spheres, n joints.
struct SphereCenters {
  Eigen::Matrix3Xd p_WS;  ///< [m] 3 x S
  Eigen::MatrixXd Jq;     ///< 3S x n, d p_WS / d q; empty unless asked for
};

/// A robot as data: a tree of joints that begins at its base, their limits, collision spheres,
/// named configurations. Immutable; safe from many threads. Frames: W the world, B the base (X_WB
/// is fixed), L_i the link that joint i carries. A configuration q holds one number of each joint
/// that moves by itself, in the order of the joints: rad, or m of one that slides.
class RobotModel {
 public:
  /// Reads the robot.yaml (its keys: docs/robots.md) of the folder of this name,
  /// or of a variant of it (core/model_name.h).
  /// @throws InputError FILE:LINE: KEY: WHY; for a name without such a file, the known names.
  static RobotModel Load(const ModelFolders& models, const std::string& name, const Pose& X_WB);
  /// The same from a robot's folder, whose name is the robot's. @param variant may be empty.
  static RobotModel FromFolder(const std::string& folder, const std::string& variant,
                               const Pose& X_WB);
  /// The same from a file of any name.
  static RobotModel FromFile(const std::string& path, const Pose& X_WB);

  /// The robots there are: those whose folder holds a robot.yaml, sorted.
  static std::vector<std::string> ListNames(const ModelFolders& models);

  /// Numbers of a configuration; more are refused.
  static constexpr int kMaxJoints = 16;
  /// More are refused.
  static constexpr std::size_t kMaxCapsules = 32;

  const std::string& name() const { return name_; }
  const std::string& file() const { return file_; }  ///< where it was read
  /// The line there of what only other modules can judge, by its path (`joints[2].dh`,
  /// `joints[2].limits.q_min_rad`, `mount.links`, ...); 1 for any other.
  int LineOf(const std::string& key) const;
  const Pose& X_WB() const { return X_WB_; }
  /// How many numbers a configuration has.
  int num_joints() const { return static_cast<int>(limits_.size()); }
  int num_spheres() const { return static_cast<int>(spheres_.size()); }
  /// Of each number of a configuration: the joint's name, its number among joints(), its limits.
  const std::vector<std::string>& joint_names() const { return joint_names_; }
  const std::vector<int>& moving_joints() const { return moving_joints_; }
  const std::vector<JointLimits>& limits() const { return limits_; }

  /// The whole tree, fixed joints and those that mimic others with it, parents before children.
  const std::vector<Joint>& joints() const { return joints_; }
  const std::string& base() const { return base_; }  ///< the base link's name
  const Kinematics& kinematics() const { return kinematics_; }
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

  /// X_WL of the link of each of joints(), for q of shape n.
  /// @throws std::invalid_argument for a q of the wrong shape.
  std::vector<Pose> ComputeLinkPoses(const Eigen::VectorXd& q) const;
  /// Where the tool frame is: robot.yaml's `tool_frame`, or else the link of the last joint.
  Pose ComputeToolPose(const Eigen::VectorXd& q) const;

  /// Centres of all spheres and, if asked, their Jacobian: of a joint that turns, with the axis z
  /// and a point o of it, z x (p_s - o), of one that slides z; zero for joints that do not carry
  /// the sphere's link. No allocation beyond the result.
  /// @throws std::invalid_argument for a q of the wrong shape.
  SphereCenters ComputeSphereCenters(const Eigen::VectorXd& q, bool with_jacobian) const;

 private:
  RowPlaces PlacesAt(const Eigen::VectorXd& q) const;
  Pose PoseOf(int link, const RowPlaces& places) const;

  std::string name_, file_, base_;
  std::map<std::string, int> lines_;
  Pose X_WB_;
  std::vector<Joint> joints_;
  Kinematics kinematics_;
  std::vector<std::string> joint_names_;
  std::vector<int> moving_joints_;
  std::vector<JointLimits> limits_;
  int tool_link_ = -1;
  std::optional<Pose> X_LTool_;  // where it is not the link's frame
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
