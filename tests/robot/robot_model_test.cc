#include "sidestep/robot/robot_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <ostream>
#include <stdexcept>
#include <string>

namespace sidestep::robot::robot_model_test {
namespace {

constexpr double kPi = 3.141592653589793;
const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

Eigen::VectorXd Vector(std::initializer_list<double> values) {
  return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<int>(values.size()));
}

// Published positions of the last DH frame, in the base frame. `tolerance_m` is half a unit of the
// last digit given.
struct FlangeCase {
  std::string name, robot;
  Eigen::VectorXd q;
  Eigen::Vector3d p_BF;
  double tolerance_m;
};
std::ostream& operator<<(std::ostream& stream, const FlangeCase& c) { return stream << c.name; }

class PublishedFlange : public ::testing::TestWithParam<FlangeCase> {};

TEST_P(PublishedFlange, IsReached) {
  const RobotModel robot = RobotModel::Load(kModels, GetParam().robot, Pose());
  const Pose X_BF = robot.ComputeLinkPoses(GetParam().q).back();
  EXPECT_LE((X_BF.translation() - GetParam().p_BF).cwiseAbs().maxCoeff(), GetParam().tolerance_m)
      << X_BF.translation().transpose();
}

INSTANTIATE_TEST_SUITE_P(
    Figures, PublishedFlange,
    ::testing::Values(
        FlangeCase{"PandaAtZero", "panda", Eigen::VectorXd::Zero(7), {0.088, 0, 0.926}, 1e-12},
        FlangeCase{"PandaReady",
                   "panda",
                   Vector({0, -kPi / 4, 0, -3 * kPi / 4, 0, kPi / 2, kPi / 4}),
                   {0.3069, 0, 0.5903},
                   5e-5},
        FlangeCase{"WamAtZero", "wam", Eigen::VectorXd::Zero(7), {0, 0, 0.910}, 1e-12},
        FlangeCase{"WamReaching",
                   "wam",
                   Vector({1.58, 1.1, 0, 1.7, 0, -1.24, 1.57}),
                   {-0.0066, 0.7134, -0.0576},
                   5e-5},
        FlangeCase{"WamDown",
                   "wam",
                   Vector({0, 0.97, 0, 1.6, 0, -0.919, 1.57}),
                   {0.7391, 0, 0.0410},
                   5e-5}),
    [](const auto& test) { return test.param.name; });

TEST(RobotModel, PutsTheSpheresOfTheWamWhereGpmp2PutsThem) {
  const RobotModel wam = RobotModel::Load(kModels, "wam", Pose());
  const SphereCenters spheres =
      wam.ComputeSphereCenters(wam.configurations().at("pose1"), /*with_jacobian=*/false);
  const Eigen::Vector3d elbow(-0.347511658501, 0.422246388756, -0.073950215608);
  const Eigen::Vector3d finger(-0.284257216582, 0.939785131234, -0.128106861879);
  EXPECT_LE((spheres.p_WS.col(5) - elbow).norm(), 2e-12);
  EXPECT_LE((spheres.p_WS.col(13) - finger).norm(), 2e-12);
  EXPECT_EQ(spheres.Jq.size(), 0);
}

// The vendor's table is in the modified (Craig) convention:
// Rx(alpha_{i-1}) Tx(a_{i-1}) Rz(q_i) Tz(d_i), then the flange and the hand's turn by -pi/4.
TEST(RobotModel, AgreesWithTheVendorsModifiedDhTableOfThePanda) {
  const double a[] = {0, 0, 0, 0.0825, -0.0825, 0, 0.088};
  const double alpha[] = {0, -kPi / 2, kPi / 2, kPi / 2, -kPi / 2, kPi / 2, kPi / 2};
  const double d[] = {0.333, 0, 0.316, 0, 0.384, 0, 0};
  const RobotModel panda = RobotModel::Load(kModels, "panda", Pose());
  for (const auto& [name, q] : panda.configurations()) {
    Eigen::Isometry3d X_BL = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 7; ++i) {
      X_BL = X_BL * Eigen::AngleAxisd(alpha[i], Eigen::Vector3d::UnitX()) *
             Eigen::Translation3d(a[i], 0, 0) * Eigen::AngleAxisd(q(i), Eigen::Vector3d::UnitZ()) *
             Eigen::Translation3d(0, 0, d[i]);
    }
    X_BL = X_BL * Eigen::Translation3d(0, 0, 0.107) *
           Eigen::AngleAxisd(-kPi / 4, Eigen::Vector3d::UnitZ());
    const Pose X_BH = panda.ComputeLinkPoses(q).back();
    EXPECT_LE((X_BH.translation() - X_BL.translation()).norm(), 1e-14) << name;
    EXPECT_LE((X_BH.rotation().toRotationMatrix() - X_BL.linear()).norm(), 1e-14) << name;
  }
}

TEST(RobotModel, MovesEverythingWithItsBase) {
  const Pose X_WB = Pose::FromRollPitchYaw({0.3, -0.2, 1.1}, {0.4, -0.7, 0.9});
  const RobotModel at_origin = RobotModel::Load(kModels, "panda", Pose());
  const RobotModel moved = RobotModel::Load(kModels, "panda", X_WB);
  const Eigen::VectorXd& q = moved.configurations().at("table_left");
  const SphereCenters expected = at_origin.ComputeSphereCenters(q, true);
  const SphereCenters actual = moved.ComputeSphereCenters(q, true);
  for (int s = 0; s < moved.num_spheres(); ++s) {
    EXPECT_LE((actual.p_WS.col(s) - X_WB * expected.p_WS.col(s)).norm(), 1e-14);
    for (int j = 0; j < moved.num_joints(); ++j) {
      const Eigen::Vector3d column = expected.Jq.block<3, 1>(3 * s, j);
      const Eigen::Vector3d difference = actual.Jq.block<3, 1>(3 * s, j) - X_WB.Rotate(column);
      EXPECT_LE(difference.norm(), 1e-14);
    }
  }
}

TEST(RobotModel, RefusesAConfigurationOfTheWrongShape) {
  const RobotModel panda = RobotModel::Load(kModels, "panda", Pose());
  EXPECT_THROW(panda.ComputeSphereCenters(Eigen::VectorXd::Zero(6), true), std::invalid_argument);
  EXPECT_THROW(panda.ComputeLinkPoses(Eigen::VectorXd::Zero(8)), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::robot::robot_model_test
