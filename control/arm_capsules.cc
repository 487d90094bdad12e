#include "sidestep/control/arm_capsules.h"

#include <algorithm>
#include <cmath>

namespace sidestep::control {

ArmCapsules::ArmCapsules(const robot::RobotModel& robot)
    : num_joints_(robot.num_joints()),
      size_(static_cast<int>(robot.capsules().size())),
      dh_{},
      R_WB_(robot.X_WB().rotation().toRotationMatrix()),
      p_WB_(robot.X_WB().translation()) {
  std::copy(robot.dh().begin(), robot.dh().end(), dh_.begin());
  std::copy(robot.capsules().begin(), robot.capsules().end(), capsules_.begin());
}

void ArmCapsules::Place(const JointVector& q, All& placed) const noexcept {
  std::array<Eigen::Matrix3d, kMaxJoints + 1> R;  // of the base, then after each row
  std::array<Eigen::Vector3d, kMaxJoints + 1> p;
  R[0] = R_WB_;
  p[0] = p_WB_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(num_joints_); ++i) {
    const robot::DhRow& row = dh_[i];
    const double angle = q(static_cast<Eigen::Index>(i)) + row.theta_rad;
    const double c = std::cos(angle), s = std::sin(angle);
    const double ca = std::cos(row.alpha_rad), sa = std::sin(row.alpha_rad);
    const Eigen::Vector3d x = c * R[i].col(0) + s * R[i].col(1);  // after Rz
    const Eigen::Vector3d y = c * R[i].col(1) - s * R[i].col(0);
    const Eigen::Vector3d z = R[i].col(2);
    p[i + 1] = p[i] + row.d_m * z + row.a_m * x;
    R[i + 1].col(0) = x;
    R[i + 1].col(1) = ca * y + sa * z;
    R[i + 1].col(2) = ca * z - sa * y;
  }
  for (std::size_t k = 0; k < static_cast<std::size_t>(size_); ++k) {
    const robot::CollisionCapsule& capsule = capsules_[k];
    const int after_row = capsule.link + 1;
    const auto frame = static_cast<std::size_t>(after_row);
    placed[k] = {p[frame] + R[frame] * capsule.p_LA, p[frame] + R[frame] * capsule.p_LB,
                 capsule.radius_m, capsule.link >= 0};
  }
}

}  // namespace sidestep::control
