// What sim/arm_survey finds of arms that were imported.
#include "sidestep/sim/arm_survey.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/import/arm_of_tree.h"
#include "sidestep/import/arm_pose.h"
#include "sidestep/import/home_candidates.h"
#include "sidestep/import/robot_files.h"
#include "sidestep/import/urdf_tree.h"
#include "sidestep/sim/arm_file.h"

namespace sidestep::imports::arm_survey_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Case {
  const char *name, *file, *tip;
};
std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

class ArmSurvey : public ::testing::TestWithParam<Case> {
 protected:
  ArmSurvey() {
    ArmChoices choices;
    choices.name = "arm";
    choices.tip = GetParam().tip;
    const std::string path = std::string(SIDESTEP_SOURCE_DIR "/tests/data/urdf/") + GetParam().file;
    arm_ = ArmOfTree(ReadUrdfTree(path, choices), choices).arm;
    Compile();
    settings_.configurations = SampleConfigurations(arm_, 500);
    settings_.candidates = HomeCandidates(arm_);
  }

  void Compile() {
    model_ = sim::LoadArmText(MjcfText(arm_, PairsWithoutContact(arm_, {})), "arm.xml");
    data_ = sim::MakeMujocoData(*model_);
  }

  void MoveTo(const VectorXd& q) {
    for (const robot::Joint& joint : arm_.joints) {
      const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.name.c_str());
      if (id < 0) continue;
      data_->qpos[model_->jnt_qposadr[id]] = joint.multiplier * q(joint.coordinate) + joint.offset;
    }
    mj_fwdPosition(model_.get(), data_.get());
  }

  robot::ArmDescription arm_;
  sim::SurveySettings settings_;
  sim::MujocoModelPtr model_;
  sim::MujocoDataPtr data_;
};

TEST_P(ArmSurvey, CallsFreeWhatTouchesNothing) {
  const sim::ArmSurvey survey = SurveyArm(*model_, arm_, settings_);
  ASSERT_FALSE(survey.free.empty());
  EXPECT_TRUE(survey.always.empty());
  std::size_t free = 0;
  for (const VectorXd& q : settings_.candidates) {
    MoveTo(q);
    bool touches = false;
    for (int i = 0; i < data_->ncon; ++i) touches = touches || data_->contact[i].dist <= 0;
    free += !touches;
  }
  EXPECT_EQ(survey.free.size(), free);
}

// The rule of every_model_test, at other configurations than the gains were found at.
TEST_P(ArmSurvey, FindsGainsThatHoldTheArmStillEverywhere) {
  const sim::ArmSurvey survey = SurveyArm(*model_, arm_, settings_);
  for (std::size_t i = 0; i < arm_.joints.size(); ++i) {
    if (arm_.joints[i].coordinate < 0 || arm_.joints[i].multiplier != 1) continue;
    arm_.dynamics[i].armature = survey.armature(arm_.joints[i].coordinate);
  }
  Compile();
  const auto n = static_cast<Eigen::Index>(arm_.limits.size());
  MatrixXd dofs = MatrixXd::Zero(model_->nv, n);
  for (const robot::Joint& joint : arm_.joints) {
    const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.name.c_str());
    if (id >= 0) dofs(model_->jnt_dofadr[id], joint.coordinate) = joint.multiplier;
  }
  const double h = 0.001;
  RandomStream random(7, "other configurations");
  for (int trial = 0; trial < 200; ++trial) {
    VectorXd q(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const robot::JointLimits& limits = arm_.limits[static_cast<std::size_t>(j)];
      q(j) = random.Uniform(std::max(limits.q_min, -3.0), std::min(limits.q_max, 3.0));
    }
    MoveTo(q);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> all(model_->nv,
                                                                               model_->nv);
    mj_fullM(model_.get(), all.data(), data_->qM);
    const MatrixXd M = dofs.transpose() * all * dofs;
    const MatrixXd K = M.ldlt().solve(MatrixXd(survey.stiffness.asDiagonal()));
    const MatrixXd D = M.ldlt().solve(MatrixXd(survey.damping.asDiagonal()));
    const MatrixXd I = MatrixXd::Identity(n, n);
    MatrixXd step(2 * n, 2 * n);
    step << I - h * h * K, h * (I - h * D), -h * K, I - h * D;
    for (const std::complex<double>& z : Eigen::VectorXcd(step.eigenvalues())) {
      ASSERT_LT(std::abs(z), 1) << "unstable at " << q.transpose();
      const std::complex<double> s = std::log(z);
      ASSERT_GT(-s.real() / std::abs(s), 0.4) << "rings at " << q.transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Urdfs, ArmSurvey,
                         ::testing::Values(Case{"SixAxis", "six_axis.urdf", ""},
                                           Case{"SevenAxis", "arm_parts/urdf/seven_axis.urdf", ""},
                                           Case{"Slider", "slider.urdf", ""},
                                           Case{"Gripper", "mimic_gripper.urdf", ""},
                                           Case{"Branch", "branch.urdf", "left_hand"}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::imports::arm_survey_test
