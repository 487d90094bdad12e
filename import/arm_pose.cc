#include "sidestep/import/arm_pose.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "sidestep/core/random.h"

namespace sidestep::imports {

std::vector<Pose> LinkPosesAt(const robot::ArmDescription& arm, const Eigen::VectorXd& q) {
  std::vector<Pose> poses;
  for (const robot::Joint& joint : arm.joints) {
    const Pose X_BP = joint.parent < 0 ? Pose() : poses[static_cast<std::size_t>(joint.parent)];
    Pose X_JL;
    if (joint.kind != robot::JointKind::kFixed) {
      const double position = joint.multiplier * q(joint.coordinate) + joint.offset;
      X_JL = robot::MotionOf(joint.kind, joint.axis_J, position);
    }
    poses.push_back(X_BP * joint.X_PJ * X_JL);
  }
  return poses;
}

std::vector<Eigen::VectorXd> SampleConfigurations(const robot::ArmDescription& arm, int count) {
  constexpr double kPi = 3.141592653589793;
  std::vector<double> unlimited(arm.limits.size(), kPi);
  for (const robot::Joint& joint : arm.joints) {
    const bool slides = joint.kind == robot::JointKind::kPrismatic;
    if (slides && joint.coordinate >= 0) {
      unlimited[static_cast<std::size_t>(joint.coordinate)] = 1;
    }
  }
  RandomStream random(1, "import");
  std::vector<Eigen::VectorXd> samples;
  for (int i = 0; i < count; ++i) {
    Eigen::VectorXd q(static_cast<Eigen::Index>(arm.limits.size()));
    for (std::size_t j = 0; j < arm.limits.size(); ++j) {
      const robot::JointLimits& limits = arm.limits[j];
      const double first = std::max(limits.q_min, std::min(-unlimited[j], limits.q_max - 1));
      const double last = std::min(limits.q_max, std::max(unlimited[j], limits.q_min + 1));
      q(static_cast<Eigen::Index>(j)) = random.Uniform(first, last);
    }
    samples.push_back(q);
  }
  return samples;
}

Eigen::Vector3d RollPitchYawOf(const Eigen::Matrix3d& R) {
  // Where the pitch is nearly a right angle, yaw is what rounding makes it, and roll makes up for
  // it.
  const double yaw = std::hypot(R(0, 0), R(1, 0)) < 1e-15 ? 0 : std::atan2(R(1, 0), R(0, 0));
  const Eigen::Matrix3d S =
      Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R;
  return {std::atan2(-S(1, 2), S(1, 1)), std::atan2(-S(2, 0), S(0, 0)), yaw};
}

}  // namespace sidestep::imports
