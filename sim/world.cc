#include "sidestep/sim/world.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/sim/contact_room.h"
#include "sidestep/sim/tied_joints.h"

namespace sidestep::sim {
World::World(const scenarios::Scenario& scenario, std::string xml, MujocoModelPtr model,
             const std::vector<std::string>& joints, const Eigen::VectorXd& q_start)
    : xml_(std::move(xml)),
      model_(std::move(model)),
      data_(MakeMujocoData(*model_)),
      obstacles_(scenario.moving_obstacles) {
  if (q_start.size() != static_cast<Eigen::Index>(joints.size()) || !q_start.allFinite()) {
    throw std::invalid_argument("World: q_start must hold one finite number for each joint");
  }
  for (const std::string& name : joints) joints_.push_back(FindJoint(name, scenario.file));
  for (const scenarios::MovingObstacle& obstacle : obstacles_) {
    const int body = mj_name2id(model_.get(), mjOBJ_BODY, obstacle.name.c_str());
    const int mocap = body < 0 ? -1 : model_->body_mocapid[body];
    if (mocap < 0) throw InputError(scenario.file, "no mocap body '" + obstacle.name + "'");
    mocap_ids_.push_back(mocap);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    data_->qpos[joints_[i].qpos] = q_start(static_cast<Eigen::Index>(i));
  }
  FollowLeaders(*model_, data_.get());
  MoveObstacles();
  ComputeWhatFollows();
}

World::Joint World::FindJoint(const std::string& name, const std::string& file) const {
  const mjModel& m = *model_;
  const int joint = mj_name2id(&m, mjOBJ_JOINT, name.c_str());
  if (joint < 0) throw InputError(file, "the robot's model has no joint '" + name + "'");
  for (int motor = 0; motor < m.nu; ++motor) {
    if (m.actuator_trntype[motor] != mjTRN_JOINT || m.actuator_trnid[2 * motor] != joint) continue;
    const bool is_plain =
        m.actuator_dyntype[motor] == mjDYN_NONE && m.actuator_gaintype[motor] == mjGAIN_FIXED &&
        m.actuator_biastype[motor] == mjBIAS_NONE && m.actuator_gainprm[mjNGAIN * motor] == 1 &&
        m.actuator_gear[6 * motor] == 1;
    if (!is_plain) break;
    return {m.jnt_qposadr[joint], m.jnt_dofadr[joint], motor};
  }
  throw InputError(file, "the robot's model has no motor of gear 1 at joint '" + name + "'");
}

void World::Step(const Eigen::VectorXd& torque) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    data_->ctrl[joints_[i].motor] = torque(static_cast<Eigen::Index>(i));
  }
  // mj_step in two halves, the second one first: so the state that is left behind is complete.
  mj_step2(model_.get(), data_.get());
  CheckPhysics();
  ++ticks_;
  data_->time = time().seconds();
  MoveObstacles();
  ComputeWhatFollows();
}

void World::BeginAnew() {
  ticks_ = 0;
  data_->time = 0;
  mju_zero(data_->qvel, model_->nv);
  MoveObstacles();
  ComputeWhatFollows();
}

void World::ComputeWhatFollows() {
  mj_step1(model_.get(), data_.get());
  while (LacksContactRoom(*data_) && DoubleContactRoom(model_.get(), &data_)) {
    mj_step1(model_.get(), data_.get());
  }
  CheckPhysics();
}

std::int64_t World::TickNotBefore(EpisodeTime t) {
  constexpr double kTolerance = 1e-6;  // of a tick
  return static_cast<std::int64_t>(std::ceil(t.seconds() * kTicksPerSecond - kTolerance));
}

void World::MoveObstacles() {
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Pose X_WO = PoseAt(obstacles_[i], time());
    const Eigen::Quaterniond& R = X_WO.rotation();
    Eigen::Map<Eigen::Vector3d>(data_->mocap_pos + 3 * mocap_ids_[i]) = X_WO.translation();
    Eigen::Map<Eigen::Vector4d>(data_->mocap_quat + 4 * mocap_ids_[i]) << R.w(), R.x(), R.y(),
        R.z();
  }
}

void World::CheckPhysics() const {
  if (const auto warning = MujocoWarning(*data_)) {
    throw SimulationError("at " + ShortestText(time().seconds()) + " s: MuJoCo: " + *warning);
  }
}

Eigen::VectorXd World::Gather(const mjtNum* of_dofs) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(joints_.size()));
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    values(static_cast<Eigen::Index>(i)) = of_dofs[joints_[i].dof];
  }
  return values;
}

Eigen::VectorXd World::q() const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(joints_.size()));
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    values(static_cast<Eigen::Index>(i)) = data_->qpos[joints_[i].qpos];
  }
  return values;
}

Eigen::VectorXd World::v() const { return Gather(data_->qvel); }
Eigen::VectorXd World::bias_torque() const { return Gather(data_->qfrc_bias); }
Eigen::VectorXd World::motor_torque() const { return Gather(data_->qfrc_actuator); }

}  // namespace sidestep::sim
