#include "sidestep/sim/fci/panda_plant.h"

#include <Eigen/Dense>
#include <cmath>
#include <stdexcept>

namespace sidestep::sim::fci {
namespace {

using robot::fci::Joints;
using robot::fci::kNumJoints;
using robot::fci::Matrix4;
using robot::fci::Wrench;

using JointVector = Eigen::Matrix<double, kNumJoints, 1>;
using WrenchVector = Eigen::Matrix<double, 6, 1>;

Eigen::Map<const Eigen::Matrix4d> AsMatrix(const Matrix4& T) {
  return Eigen::Map<const Eigen::Matrix4d>(T.data());
}

Matrix4 FromMatrix(const Eigen::Matrix4d& T) {
  Matrix4 result;
  Eigen::Map<Eigen::Matrix4d>(result.data()) = T;
  return result;
}

Joints FromVector(const Eigen::VectorXd& vector) {
  Joints result;
  Eigen::Map<JointVector>(result.data()) = vector;
  return result;
}

// From the flange to the frame after the last row of robot.yaml.
constexpr double kHandTurn = -0.7853981633974483;

}  // namespace

Matrix4 Identity4() { return FromMatrix(Eigen::Matrix4d::Identity()); }

Matrix4 Product(const Matrix4& A, const Matrix4& B) {
  return FromMatrix(AsMatrix(A) * AsMatrix(B));
}

bool IsTransform(const Matrix4& T) {
  constexpr double kTolerance = 1e-5;
  const Eigen::Matrix4d M = AsMatrix(T);
  if (!M.allFinite()) return false;
  const Eigen::Matrix3d R = M.topLeftCorner<3, 3>();
  const bool is_rotation =
      (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kTolerance &&
      R.determinant() > 0;
  return is_rotation && M.row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

Matrix4 HandFrame() {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(kHandTurn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T(2, 3) = 0.1034;
  return FromMatrix(T);
}

PandaPlant::PandaPlant(const robot::RobotModel& robot, World* world)
    : world_(*world), robot_(robot) {
  if (robot.num_joints() != kNumJoints || world_.q().size() != kNumJoints) {
    throw std::invalid_argument("PandaPlant: the robot must have seven joints");
  }
  const mjModel& model = world_.model();
  for (std::size_t i = 0; i < limits_.size(); ++i) {
    limits_[i] = robot.limits()[i];
    const int joint = mj_name2id(&model, mjOBJ_JOINT, robot.joint_names()[i].c_str());
    dofs_[i] = model.jnt_dofadr[joint];
  }
  impedance_.stiffness = FromVector(robot.stiffness());
  impedance_.damping = FromVector(robot.damping());
  hand_site_ = mj_name2id(&model, mjOBJ_SITE, "dh7");
  if (hand_site_ < 0) throw std::invalid_argument("PandaPlant: the model has no site dh7");
}

Joints PandaPlant::q() const { return FromVector(world_.q()); }
Joints PandaPlant::dq() const { return FromVector(world_.v()); }
Joints PandaPlant::holding_torque() const { return FromVector(world_.bias_torque()); }
Joints PandaPlant::motor_torque() const {
  Joints torque = FromVector(world_.motor_torque());
  for (std::size_t i = 0; i < torque.size(); ++i) torque[i] -= disturbance_[i];
  return torque;
}

void PandaPlant::BeginAnew() {
  disturbance_ = {};
  world_.BeginAnew();
  if (after_step_) after_step_();
}

void PandaPlant::Step(const Joints& torque, const Joints& disturbance) {
  disturbance_ = disturbance;
  const Eigen::Map<const JointVector> motors(torque.data()), others(disturbance.data());
  world_.Step(motors + others + world_.bias_torque());
  if (after_step_) after_step_();
}

Matrix4 PandaPlant::O_T_EE(const Joints& q, const Matrix4& F_T_EE) const {
  const Pose X_WL = robot_.ComputeLinkPoses(Eigen::Map<const JointVector>(q.data())).back();
  const Pose X_OL = robot_.X_WB().Inverse() * X_WL;
  Eigen::Matrix4d O_T_F = Eigen::Matrix4d::Identity();
  O_T_F.topLeftCorner<3, 3>() =
      X_OL.rotation().toRotationMatrix() *
      Eigen::AngleAxisd(-kHandTurn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  O_T_F.topRightCorner<3, 1>() = X_OL.translation();
  return FromMatrix(O_T_F * AsMatrix(F_T_EE));
}

PandaPlant::Jacobian PandaPlant::HandJacobian() const {
  const mjModel& model = world_.model();
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> linear(3, model.nv),
      angular(3, model.nv);
  mj_jacSite(&model, &world_.data(), linear.data(), angular.data(), hand_site_);
  const Eigen::Matrix3d R_OW = robot_.X_WB().rotation().toRotationMatrix().transpose();
  Jacobian J;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    J.block<3, 1>(0, column) = R_OW * linear.col(dofs_[i]);
    J.block<3, 1>(3, column) = R_OW * angular.col(dofs_[i]);
  }
  return J;
}

ExternalForce PandaPlant::external() const {
  ExternalForce force;
  const Eigen::Map<const Eigen::VectorXd> constraint(world_.data().qfrc_constraint,
                                                     world_.model().nv);
  bool is_free = true;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    force.tau[i] = constraint(dofs_[i]) + disturbance_[i];
    is_free = is_free && force.tau[i] == 0;
  }
  if (is_free) return force;  // nearly always
  constexpr double kDamping = 1e-4;
  const Jacobian J = HandJacobian();
  const Eigen::Matrix<double, 6, 6> JJt =
      J * J.transpose() + kDamping * Eigen::Matrix<double, 6, 6>::Identity();
  Eigen::Map<WrenchVector>(force.O_F_K.data()) =
      JJt.ldlt().solve(J * Eigen::Map<const JointVector>(force.tau.data()));
  return force;
}

ExternalForce PandaPlant::AtTheHand(const Wrench& O_F) const {
  ExternalForce force;
  force.O_F_K = O_F;
  Eigen::Map<JointVector>(force.tau.data()) =
      HandJacobian().transpose() * Eigen::Map<const WrenchVector>(O_F.data());
  return force;
}

std::array<double, 3> PandaPlant::hand_velocity() const {
  const Joints velocity = dq();
  const Eigen::Vector3d v =
      HandJacobian().topRows<3>() * Eigen::Map<const JointVector>(velocity.data());
  return {v.x(), v.y(), v.z()};
}

}  // namespace sidestep::sim::fci
