#include "sidestep/sim/arm_survey.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "sidestep/sim/mujoco_model.h"

namespace sidestep::sim {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Pair = std::pair<int, int>;

constexpr double kNearlyAlways = 0.95;  // of the configurations
constexpr double kControlTick_s = 0.001;
constexpr double kLeastDamping = 0.5;  // of every mode, relative to the critical one
constexpr std::size_t kGainConfigurations = 300;

class Survey {
 public:
  Survey(const mjModel& model, const robot::ArmDescription& arm)
      : model_(model), arm_(arm), data_(MakeMujocoData(model)) {
    const auto n = static_cast<Eigen::Index>(arm.limits.size());
    dofs_of_ = MatrixXd::Zero(model.nv, n);
    for (const robot::Joint& joint : arm.joints) {
      const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
      joints_.push_back(id);
      if (id >= 0) dofs_of_(model.jnt_dofadr[id], joint.coordinate) = joint.multiplier;
    }
    for (int link = -1; link < static_cast<int>(arm.joints.size()); ++link) {
      const int body = mj_name2id(&model, mjOBJ_BODY, arm.LinkOf(link).name.c_str());
      links_[body] = link;
    }
  }

  void MoveTo(const VectorXd& q) {
    for (std::size_t i = 0; i < arm_.joints.size(); ++i) {
      const robot::Joint& joint = arm_.joints[i];
      if (joints_[i] < 0) continue;
      data_->qpos[model_.jnt_qposadr[joints_[i]]] =
          joint.multiplier * q(joint.coordinate) + joint.offset;
    }
    mj_kinematics(&model_, data_.get());
    mj_comPos(&model_, data_.get());
  }

  std::set<Pair> Touching() {
    mj_collision(&model_, data_.get());
    std::set<Pair> pairs;
    for (int i = 0; i < data_->ncon; ++i) {
      const mjContact& contact = data_->contact[i];
      const int a = links_.at(model_.geom_bodyid[contact.geom1]);
      const int b = links_.at(model_.geom_bodyid[contact.geom2]);
      if (contact.dist <= 0) pairs.emplace(std::min(a, b), std::max(a, b));
    }
    return pairs;
  }

  // Of the coordinates, those that mimic others with them.
  MatrixXd Inertia() {
    mj_crb(&model_, data_.get());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> M(model_.nv, model_.nv);
    mj_fullM(&model_, M.data(), data_->qM);
    return dofs_of_.transpose() * M * dofs_of_;
  }

 private:
  const mjModel& model_;
  const robot::ArmDescription& arm_;
  MujocoDataPtr data_;
  std::vector<int> joints_;   // in the model, of each joint; -1 of one that is fixed
  std::map<int, int> links_;  // by body
  MatrixXd dofs_of_;          // how each number of a configuration moves the model's joints
};

enum class Answer { kGood, kUnstable, kRings };

// An error under gains that are applied once a tick: v' = v - h M^-1 (K e + D v), e' = e + h v'.
Answer Try(const MatrixXd& M, const VectorXd& stiffness, const VectorXd& damping) {
  const Eigen::Index n = M.rows();
  const double h = kControlTick_s;
  const auto solver = M.ldlt();
  const MatrixXd K = solver.solve(MatrixXd(stiffness.asDiagonal()));
  const MatrixXd D = solver.solve(MatrixXd(damping.asDiagonal()));
  const MatrixXd I = MatrixXd::Identity(n, n);
  MatrixXd step(2 * n, 2 * n);
  step << I - h * h * K, h * (I - h * D), -h * K, I - h * D;
  Answer answer = Answer::kGood;
  const Eigen::VectorXcd modes = step.eigenvalues();
  for (const std::complex<double>& z : modes) {
    if (!(std::abs(z) < 1)) return Answer::kUnstable;
    const std::complex<double> s = std::log(z);
    if (z.real() < 0) return Answer::kUnstable;  // turns its sign every tick
    if (!(-s.real() / std::abs(s) > kLeastDamping)) answer = Answer::kRings;
  }
  return answer;
}

// To three digits: more would only look exact.
double ToThreeDigits(double value) {
  if (!(value > 0)) return 0;
  const double power = 2 - std::floor(std::log10(value));
  const double scale = std::pow(10.0, std::abs(power));
  return power < 0 ? std::round(value / scale) * scale : std::round(value * scale) / scale;
}

void FindGains(const robot::ArmDescription& arm, std::vector<MatrixXd> inertias,
               const SurveySettings& settings, ArmSurvey* survey) {
  VectorXd alone = VectorXd::Zero(inertias.front().rows());
  for (const MatrixXd& M : inertias) alone = alone.cwiseMax(M.diagonal());
  survey->armature = (settings.armature_share * alone).unaryExpr(&ToThreeDigits);
  for (std::size_t i = 0; i < arm.joints.size(); ++i) {
    if (arm.dynamics[i].armature > 0) survey->armature(arm.joints[i].coordinate) = 0;
  }
  for (MatrixXd& M : inertias) M.diagonal() += survey->armature;
  alone += survey->armature;
  double bandwidth = settings.bandwidth_rad_s, ratio = 1;
  for (int attempt = 0; attempt < 100; ++attempt) {
    survey->bandwidth_rad_s = ToThreeDigits(bandwidth);
    survey->stiffness = (bandwidth * bandwidth * alone).unaryExpr(&ToThreeDigits);
    survey->damping = (2 * ratio * bandwidth * alone).unaryExpr(&ToThreeDigits);
    Answer worst = Answer::kGood;
    for (const MatrixXd& M : inertias) {
      const Answer answer = Try(M, survey->stiffness, survey->damping);
      if (answer == Answer::kGood) continue;
      worst = answer;
      if (answer == Answer::kUnstable) break;
    }
    if (worst == Answer::kGood) return;
    if (worst == Answer::kRings) {
      ratio *= 1.15;
    } else {
      bandwidth *= 0.85;
    }
  }
}

}  // namespace

ArmSurvey SurveyArm(const mjModel& model, const robot::ArmDescription& arm,
                    const SurveySettings& settings) {
  Survey survey(model, arm);
  ArmSurvey found;
  std::map<Pair, std::size_t> counts;
  std::vector<MatrixXd> inertias;
  for (const VectorXd& q : settings.configurations) {
    survey.MoveTo(q);
    for (const Pair& pair : survey.Touching()) ++counts[pair];
    if (inertias.size() < kGainConfigurations) inertias.push_back(survey.Inertia());
  }
  std::set<Pair> always;
  for (const auto& [pair, count] : counts) {
    const bool nearly = static_cast<double>(count) >
                        kNearlyAlways * static_cast<double>(settings.configurations.size());
    (nearly ? found.always : found.sometimes).push_back({pair.first, pair.second});
    if (nearly) always.insert(pair);
  }
  for (const VectorXd& q : settings.candidates) {
    survey.MoveTo(q);
    const std::set<Pair> touching = survey.Touching();
    if (std::includes(always.begin(), always.end(), touching.begin(), touching.end())) {
      found.free.push_back(q);
    }
  }
  FindGains(arm, std::move(inertias), settings, &found);
  return found;
}

}  // namespace sidestep::sim
