#include "sidestep/bench/resolve.h"

#include <fmt/core.h>

#include <algorithm>

#include "sidestep/core/input_error.h"
#include "sidestep/core/shape.h"
#include "sidestep/planner/self_clearance.h"

namespace sidestep::bench {
namespace {

class TaskChecker {
 public:
  TaskChecker(const scenarios::Scenario& scenario, const robot::RobotModel& robot)
      : scenario_(scenario), robot_(robot) {}

  Eigen::VectorXd LookUp(const std::string& key, const std::string& name,
                         const Eigen::VectorXd& joints) const {
    if (name.empty()) {
      if (joints.size() != robot_.num_joints()) {
        Fail(key, "must have " + std::to_string(robot_.num_joints()) + " joint positions, has " +
                      std::to_string(joints.size()));
      }
      return joints;
    }
    const auto found = robot_.configurations().find(name);
    if (found == robot_.configurations().end()) {
      std::string list;
      for (const auto& [known, q] : robot_.configurations()) {
        list += (list.empty() ? "" : ", ") + known;
      }
      Fail(key,
           "'" + name + "' is no configuration of " + robot_.name() + " (known: " + list + ")");
    }
    return found->second;
  }

  void CheckLimits(const std::string& key, const Eigen::VectorXd& q) const {
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const robot::JointLimits& limits = robot_.limits()[static_cast<std::size_t>(i)];
      if (q(i) < limits.q_min || q(i) > limits.q_max) {
        Fail(key, fmt::format("{} = {:.4f} rad is outside its limits [{:.4f}, {:.4f}]",
                              robot_.joint_names()[static_cast<std::size_t>(i)], q(i), limits.q_min,
                              limits.q_max));
      }
    }
  }

  void CheckSelf(const std::string& key, const Eigen::VectorXd& q) const {
    const planner::SelfClearance links(robot_);
    const Eigen::Matrix3Xd p_WS = robot_.ComputeSphereCenters(q, false).p_WS;
    for (int pair = 0; pair < links.num_pairs(); ++pair) {
      const planner::LinkGap gap = links.Find(pair, p_WS);
      if (gap.gap_m >= 0) continue;
      Fail(key, fmt::format("the robot's spheres {} and {} overlap by {:.1f} mm", gap.first,
                            gap.second, -1e3 * gap.gap_m));
    }
  }

  void CheckClear(const std::string& key, const Eigen::VectorXd& q, const std::string& object,
                  const Shape& shape, const Pose& X_WO) const {
    const robot::SphereCenters spheres = robot_.ComputeSphereCenters(q, false);
    const Pose X_OW = X_WO.Inverse();
    for (int s = 0; s < robot_.num_spheres(); ++s) {
      const bool mounted =
          std::count(robot_.mount_spheres().begin(), robot_.mount_spheres().end(), s) > 0;
      if (mounted && object == scenario_.mount) continue;
      const Eigen::Vector3d p_OS = X_OW * Eigen::Vector3d(spheres.p_WS.col(s));
      const double clearance = SignedDistance(shape, p_OS) - robot_.sphere_radii_m()(s);
      if (clearance < 0) {
        Fail(key, fmt::format("the robot's sphere {} is {:.1f} mm inside '{}'", s, -1e3 * clearance,
                              object));
      }
    }
  }

 private:
  [[noreturn]] void Fail(const std::string& key, const std::string& why) const {
    throw scenarios::WrongValue(scenario_, key, why);
  }

  const scenarios::Scenario& scenario_;
  const robot::RobotModel& robot_;
};

}  // namespace

void ResolveTask(scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  const TaskChecker check(scenario, robot);
  scenario.q_start = check.LookUp("task.start", scenario.start_name, scenario.q_start);
  scenario.q_goal = check.LookUp("task.goal", scenario.goal_name, scenario.q_goal);
  check.CheckLimits("task.start", scenario.q_start);
  check.CheckLimits("task.goal", scenario.q_goal);
  check.CheckSelf("task.start", scenario.q_start);
  check.CheckSelf("task.goal", scenario.q_goal);
  for (const scenarios::StaticBox& box : scenario.static_boxes) {
    check.CheckClear("task.start", scenario.q_start, box.name, Box{box.size_m}, box.X_WO);
    check.CheckClear("task.goal", scenario.q_goal, box.name, Box{box.size_m}, box.X_WO);
  }
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    check.CheckClear("task.start", scenario.q_start, obstacle.name, obstacle.shape,
                     PoseAt(obstacle, EpisodeTime(0)));
  }
}

}  // namespace sidestep::bench
