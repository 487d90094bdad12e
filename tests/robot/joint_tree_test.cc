// Kinematics of trees of joints: branches, slides, axes that lie anyhow, what is fixed, what
// mimics.

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <fstream>
#include <memory>
#include <string>

#include "sidestep/core/random.h"
#include "sidestep/robot/robot_model.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::robot::joint_tree_test {
namespace {

const std::string kFolder = SIDESTEP_SOURCE_DIR "/tests/data/joint_tree/";

class JointTree : public ::testing::Test {
 protected:
  JointTree() {
    char error[1000] = "";
    model_.reset(mj_loadXML((kFolder + "joint_tree.xml").c_str(), nullptr, error, sizeof error));
    if (model_ == nullptr) throw std::runtime_error(error);
    data_.reset(mj_makeData(model_.get()));
  }

  Eigen::VectorXd Draw() {
    Eigen::VectorXd q(robot_.num_joints());
    for (int j = 0; j < q.size(); ++j) {
      const JointLimits& limits = robot_.limits()[static_cast<std::size_t>(j)];
      q(j) = random_.Uniform(limits.q_min, limits.q_max);
    }
    return q;
  }

  // Puts MuJoCo's joints where robot.yaml's are, followers by their closed form.
  void MoveTo(const Eigen::VectorXd& q) {
    for (const Joint& joint : robot_.joints()) {
      if (joint.kind == JointKind::kFixed) continue;
      const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.name.c_str());
      ASSERT_GE(id, 0) << joint.name;
      double position = q(joint.coordinate);
      if (joint.name == "right_jaw") position = 0.5 * position + 0.01;
      if (joint.name == "nod") position = -2 * position + 0.1;
      data_->qpos[model_->jnt_qposadr[id]] = position;
    }
    mj_kinematics(model_.get(), data_.get());
  }

  Pose BodyPose(const std::string& name) const {
    const int body = mj_name2id(model_.get(), mjOBJ_BODY, name.c_str());
    const mjtNum* const R = data_->xquat + 4 * body;
    return Pose(Eigen::Quaterniond(R[0], R[1], R[2], R[3]),
                Eigen::Map<const Eigen::Vector3d>(data_->xpos + 3 * body));
  }

  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  RobotModel robot_ = RobotModel::FromFile(kFolder + "robot.yaml", Pose());
  RandomStream random_{1, "configurations"};
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};

TEST_F(JointTree, HasItsLinksAndItsToolWhereMujocoHasThem) {
  ASSERT_EQ(robot_.num_joints(), 5);
  for (int k = 0; k < 50; ++k) {
    const Eigen::VectorXd q = Draw();
    ASSERT_NO_FATAL_FAILURE(MoveTo(q));
    const std::vector<Pose> X_WL = robot_.ComputeLinkPoses(q);
    for (std::size_t i = 0; i < robot_.joints().size(); ++i) {
      const Pose expected = BodyPose(robot_.joints()[i].link);
      EXPECT_LE((X_WL[i].translation() - expected.translation()).norm(), 1e-12)
          << robot_.joints()[i].link;
      EXPECT_LE(X_WL[i].rotation().angularDistance(expected.rotation()), 1e-7)
          << robot_.joints()[i].link;
    }
    const int tool = mj_name2id(model_.get(), mjOBJ_SITE, "tool");
    EXPECT_LE((robot_.ComputeToolPose(q).translation() -
               Eigen::Map<const Eigen::Vector3d>(data_->site_xpos + 3 * tool))
                  .norm(),
              1e-12);
  }
}

TEST_F(JointTree, HasSphereJacobiansEqualToDifferences) {
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 20; ++k) {
    const Eigen::VectorXd q = Draw();
    const SphereCenters spheres = robot_.ComputeSphereCenters(q, /*with_jacobian=*/true);
    const std::vector<Pose> X_WL = robot_.ComputeLinkPoses(q);
    for (int s = 0; s < robot_.num_spheres(); ++s) {
      const CollisionSphere& sphere = robot_.spheres()[static_cast<std::size_t>(s)];
      const Pose X = sphere.link < 0 ? Pose() : X_WL[static_cast<std::size_t>(sphere.link)];
      EXPECT_LE((spheres.p_WS.col(s) - X * sphere.p_LS).norm(), 1e-12) << s;
    }
    for (int j = 0; j < q.size(); ++j) {
      const Eigen::VectorXd step = Eigen::VectorXd::Unit(q.size(), j) * kStep;
      const Eigen::Matrix3Xd difference = (robot_.ComputeSphereCenters(q + step, false).p_WS -
                                           robot_.ComputeSphereCenters(q - step, false).p_WS) /
                                          (2 * kStep);
      EXPECT_LE((spheres.Jq.col(j) - difference.reshaped()).cwiseAbs().maxCoeff(), 1e-9) << j;
    }
  }
}

// A row of a Denavit-Hartenberg table is a turn about z and then what is fixed.
TEST(DhRows, AreJointsAboutZAndWhatIsFixedToThem) {
  constexpr double kD_m = 0.3, kA_m = 0.2, kTheta_rad = 0.4, kAlpha_rad = -1.1;
  const TemporaryFolder folder;
  const std::string rest =
      "configurations: {}\nmount: {spheres: [], links: []}\n"
      "control: {stiffness_n_m_rad: [1, 1], damping_n_m_s_rad: [1, 1]}\n";
  const std::string by_rows = (folder.path() / "rows.yaml").string();
  const std::string by_axes = (folder.path() / "axes.yaml").string();
  std::ofstream(by_rows)
      << "name: rows\njoints:\n"
         "  - {name: a, dh: {d_m: 0.3, a_m: 0.2, theta_rad: 0.4, alpha_rad: -1.1}"
         ", limits: {}}\n"
         "  - {name: b, dh: {d_m: 0.3, a_m: 0.2, theta_rad: 0.4, alpha_rad: -1.1}"
         ", limits: {}}\n"
         "spheres: [{link: b, center_m: [0.1, 0.2, 0.3], radius_m: 0.1}]\n"
      << rest;
  // Rz(theta) Tz(d) Tx(a) Rx(alpha) as one pose.
  std::ofstream axes(by_axes);
  axes.precision(17);
  axes << "name: axes\njoints:\n";
  for (const char* const joint : {"a", "b"}) {
    axes << "  - {name: " << joint << ", link: moved_" << joint
         << ", axis: [0, 0, 1], limits: {}}\n"
         << "  - {name: turn_" << joint << ", kind: fixed, origin: {position_m: [0, 0, " << kD_m
         << "], rpy_rad: [0, 0, " << kTheta_rad << "]}}\n"
         << "  - {name: after_" << joint << ", kind: fixed, origin: {position_m: [" << kA_m
         << ", 0, 0], rpy_rad: [" << kAlpha_rad << ", 0, 0]}}\n";
  }
  axes << "spheres: [{link: after_b, center_m: [0.1, 0.2, 0.3], radius_m: 0.1}]\n" << rest;
  axes.close();

  const Pose X_WB = Pose::FromRollPitchYaw({0.3, 0.2, 0.1}, {1, 2, 3});
  const RobotModel rows = RobotModel::FromFile(by_rows, X_WB);
  const RobotModel joints = RobotModel::FromFile(by_axes, X_WB);
  ASSERT_EQ(joints.num_joints(), 2);
  RandomStream random(1, "configurations");
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector2d q(random.Uniform(-3, 3), random.Uniform(-3, 3));
    const SphereCenters expected = rows.ComputeSphereCenters(q, true);
    const SphereCenters got = joints.ComputeSphereCenters(q, true);
    EXPECT_LE((got.p_WS - expected.p_WS).norm(), 1e-12);
    EXPECT_LE((got.Jq - expected.Jq).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace sidestep::robot::joint_tree_test
