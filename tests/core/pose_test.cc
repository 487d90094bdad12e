#include "sidestep/core/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/support/random_points.h"

namespace sidestep::pose_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTight = 1e-14;

// The same pose as the textbook's 4 x 4 matrix, to compare with.
Eigen::Matrix4d Matrix(const Pose& X) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = X.rotation().toRotationMatrix();
  matrix.topRightCorner<3, 1>() = X.translation();
  return matrix;
}

TEST(Pose, IsTheIdentityByDefault) {
  EXPECT_EQ(Matrix(Pose()), Eigen::Matrix4d::Identity());
  EXPECT_EQ(Pose() * Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 2, 3));
}

TEST(Pose, ComposesAndInvertsLikeHomogeneousMatrices) {
  RandomStream random(1, "poses");
  for (int i = 0; i < 100; ++i) {
    const Pose X_AB = RandomPose(random, 2), X_BC = RandomPose(random, 2);
    EXPECT_TRUE(Matrix(X_AB * X_BC).isApprox(Matrix(X_AB) * Matrix(X_BC), kTight));
    EXPECT_TRUE(Matrix(X_AB.Inverse()).isApprox(Matrix(X_AB).inverse(), kTight));
    EXPECT_LT((Matrix(X_AB * X_AB.Inverse()) - Eigen::Matrix4d::Identity()).norm(), kTight);
  }
}

TEST(Pose, MovesPointsAndTurnsVectors) {
  RandomStream random(2, "poses");
  for (int i = 0; i < 100; ++i) {
    const Pose X_AB = RandomPose(random, 2);
    const Eigen::Vector3d p_BQ = UniformPoint(random, 2);
    const Eigen::Matrix3d R_AB = X_AB.rotation().toRotationMatrix();
    EXPECT_LT((X_AB * p_BQ - (X_AB.translation() + R_AB * p_BQ)).norm(), kTight);
    EXPECT_LT((X_AB.Rotate(p_BQ) - R_AB * p_BQ).norm(), kTight);
    EXPECT_LT((X_AB.RotateInverse(X_AB.Rotate(p_BQ)) - p_BQ).norm(), kTight);
    EXPECT_LT((X_AB.Inverse() * (X_AB * p_BQ) - p_BQ).norm(), kTight);
  }
}

TEST(Pose, TranslationOnlyMoves) {
  const Pose X = Pose::Translation({1, 2, 3});
  EXPECT_EQ(X * Eigen::Vector3d(0.5, 0, 0), Eigen::Vector3d(1.5, 2, 3));
  EXPECT_EQ(X.Rotate({1, 0, 0}), Eigen::Vector3d(1, 0, 0));
}

struct RpyCase {
  Eigen::Vector3d rpy;
  Eigen::Vector3d p_B, p_A;
};

TEST(Pose, RollTurnsAboutXFirstThenPitchAboutYThenYawAboutZ) {
  const RpyCase cases[] = {
      {{kPi / 2, 0, 0}, {0, 1, 0}, {0, 0, 1}},
      {{0, kPi / 2, 0}, {0, 0, 1}, {1, 0, 0}},
      {{0, 0, kPi / 2}, {1, 0, 0}, {0, 1, 0}},
      // About fixed axes: y -> z by the roll, -> x by the pitch, -> y by the yaw.
      {{kPi / 2, kPi / 2, kPi / 2}, {0, 1, 0}, {0, 1, 0}},
      {{kPi / 2, 0, kPi / 2}, {1, 0, 0}, {0, 1, 0}},
      {{kPi / 2, 0, kPi / 2}, {0, 1, 0}, {0, 0, 1}},
  };
  const Eigen::Vector3d p(0.1, 0.2, 0.3);
  for (const RpyCase& c : cases) {
    EXPECT_LT((Pose::FromRollPitchYaw(c.rpy, p) * c.p_B - (p + c.p_A)).norm(), 1e-15)
        << "rpy " << c.rpy.transpose();
  }
}

TEST(Pose, NormalisesItsRotation) {
  const Pose X(Eigen::Quaterniond(2, 0, 0, 2), Eigen::Vector3d::Zero());
  EXPECT_NEAR(X.rotation().norm(), 1, kTight);
  EXPECT_LT((X * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0, 1, 0)).norm(), kTight);
}

TEST(Pose, MadeAgainFromItsOwnPartsKeepsEveryBit) {
  RandomStream random(4, "poses");
  for (int i = 0; i < 10000; ++i) {
    const Pose X = RandomPose(random, 2);
    const Pose again(X.rotation(), X.translation());
    EXPECT_EQ(again.rotation().coeffs(), X.rotation().coeffs());
  }
}

TEST(Pose, RefusesAZeroRotationAndNumbersThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_THROW(Pose(Eigen::Quaterniond(0, 0, 0, 0), zero), std::invalid_argument);
  EXPECT_THROW(Pose(Eigen::Quaterniond(1, nan, 0, 0), zero), std::invalid_argument);
  EXPECT_THROW(Pose(Eigen::Quaterniond(inf, 0, 0, 0), zero), std::invalid_argument);
  EXPECT_THROW(Pose::Translation({0, 0, nan}), std::invalid_argument);
  EXPECT_THROW(Pose::FromRollPitchYaw({inf, 0, 0}, zero), std::invalid_argument);
}

// A product of many poses must stay a rotation: each product normalises.
TEST(Pose, StaysARotationOverLongProducts) {
  RandomStream random(3, "poses");
  Pose X;
  for (int i = 0; i < 10000; ++i) X = Pose(RandomPose(random, 2).rotation(), {0, 0, 0}) * X;
  EXPECT_NEAR(X.rotation().norm(), 1, kTight);
}

TEST(Pose, NormalisesRotationsOfAnyLength) {
  const Eigen::Quaterniond unit(0.5, -0.5, 0.5, 0.5);
  for (const double length : {1e-320, 1e-200, 1e-155, 1e-9, 3.0, 1e155, 1e200, 1.5e308}) {
    const Eigen::Quaterniond R(unit.coeffs() * length);
    EXPECT_TRUE(Pose(R, Eigen::Vector3d::Zero()).rotation().isApprox(unit, 1e-3)) << length;
    EXPECT_NEAR(Pose(R, Eigen::Vector3d::Zero()).rotation().norm(), 1, 1e-15) << length;
  }
}

}  // namespace
}  // namespace sidestep::pose_test
