#include "sidestep/import/arm_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "sidestep/core/random.h"

namespace sidestep::imports::arm_pose_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void ExpectComesBack(const Vector3d& rpy) {
  const Matrix3d R = Pose::FromRollPitchYaw(rpy, Vector3d::Zero()).rotation().toRotationMatrix();
  const Matrix3d back =
      Pose::FromRollPitchYaw(RollPitchYawOf(R), Vector3d::Zero()).rotation().toRotationMatrix();
  EXPECT_LT((R - back).cwiseAbs().maxCoeff(), 2e-15) << rpy.transpose();
}

TEST(RollPitchYaw, GivesTheRotationAgain) {
  RandomStream random(1, "rpy");
  for (int i = 0; i < 1000; ++i) {
    ExpectComesBack(
        {random.Uniform(-3.2, 3.2), random.Uniform(-1.6, 1.6), random.Uniform(-3.2, 3.2)});
  }
}

// Where roll and yaw turn about the same axis, as robots' frames often do.
TEST(RollPitchYaw, GivesTheRotationAgainNearARightAngleOfPitch) {
  constexpr double kRight = 1.5707963267948966;
  RandomStream random(2, "rpy");
  for (const double away : {0.0, 1e-15, 1e-12, 1e-10, 1e-9, 1e-8, 1e-6, 1e-3, 3.7e-6}) {
    for (const double pitch : {kRight - away, -kRight + away, 1.5708, -1.57}) {
      for (int i = 0; i < 20; ++i) {
        ExpectComesBack({random.Uniform(-3.2, 3.2), pitch, random.Uniform(-3.2, 3.2)});
      }
      ExpectComesBack({0, pitch, 0});
      ExpectComesBack({kRight, pitch, -kRight});
    }
  }
}

}  // namespace
}  // namespace sidestep::imports::arm_pose_test
