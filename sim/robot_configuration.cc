#include "sidestep/sim/robot_configuration.h"

#include <algorithm>
#include <string>

namespace sidestep::sim {
namespace {

constexpr double kUnlimitedRange = 3;

}  // namespace

Eigen::VectorXd DrawConfiguration(const robot::RobotModel& robot, RandomStream& random) {
  Eigen::VectorXd q(robot.num_joints());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const robot::JointLimits& limits = robot.limits()[static_cast<std::size_t>(i)];
    const double first = std::max(limits.q_min, std::min(-kUnlimitedRange, limits.q_max - 1));
    const double last = std::min(limits.q_max, std::max(kUnlimitedRange, limits.q_min + 1));
    q[i] = random.Uniform(first, last);
  }
  return q;
}

void PutAt(const robot::RobotModel& robot, const mjModel& model, const Eigen::VectorXd& q,
           mjData* data) {
  for (const robot::Joint& joint : robot.joints()) {
    const int id = mj_name2id(&model, mjOBJ_JOINT, joint.name.c_str());
    if (id < 0 || joint.coordinate < 0) continue;
    data->qpos[model.jnt_qposadr[id]] = joint.multiplier * q[joint.coordinate] + joint.offset;
  }
  mj_kinematics(&model, data);
  mj_comPos(&model, data);
}

int CarrierOf(const robot::RobotModel& robot, int link) {
  while (link >= 0 && robot.joints()[static_cast<std::size_t>(link)].coordinate < 0) {
    link = robot.joints()[static_cast<std::size_t>(link)].parent;
  }
  return link;
}

int CarrierOfBody(const robot::RobotModel& robot, const mjModel& model, int body) {
  for (; body > 0; body = model.body_parentid[body]) {
    if (model.body_jntnum[body] == 0) continue;
    const char* const name = mj_id2name(&model, mjOBJ_JOINT, model.body_jntadr[body]);
    const auto& joints = robot.joints();
    const auto found = std::find_if(joints.begin(), joints.end(), [name](const auto& joint) {
      return name != nullptr && joint.name == name;
    });
    if (found != joints.end()) return static_cast<int>(found - joints.begin());
  }
  return -1;
}

const std::string& LinkName(const robot::RobotModel& robot, int link) {
  return link < 0 ? robot.base() : robot.joints()[static_cast<std::size_t>(link)].link;
}

}  // namespace sidestep::sim
