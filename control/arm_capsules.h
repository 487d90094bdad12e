#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sidestep/control/joint_vector.h"
#include "sidestep/core/pose.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::control {

/// Where the capsules that cover an arm are, for one q. Allocates nothing after construction.
class ArmCapsules {
 public:
  static constexpr int kMax = static_cast<int>(robot::RobotModel::kMaxCapsules);

  /// In the world: the axis from a to b, and the radius.
  struct Placed {
    Eigen::Vector3d a, b;
    double radius_m = 0;
    bool moves = false;  ///< not one of the base
  };
  using All = std::array<Placed, kMax>;

  explicit ArmCapsules(const robot::RobotModel& robot);

  int size() const { return size_; }
  int num_joints() const { return num_joints_; }

  /// Fills the first size() of `placed`. @param q of the robot's number of joints.
  void Place(const JointVector& q, All& placed) const noexcept;

 private:
  struct OnRow {
    int row;                     // of the kinematics; -1: the base
    Eigen::Vector3d p_KA, p_KB;  // in its frame
    double radius_m;
  };

  int num_joints_, size_;
  std::vector<robot::KinematicRow> rows_;
  std::array<OnRow, kMax> capsules_;
  Eigen::Matrix3d R_WB_;
  Eigen::Vector3d p_WB_;
};

}  // namespace sidestep::control
