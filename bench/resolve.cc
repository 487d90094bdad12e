#include "sidestep/bench/resolve.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sidestep/bench/scenario_planner.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/solid.h"
#include "sidestep/planner/self_clearance.h"
#include "sidestep/scenarios/horizon_bounds.h"
#include "sidestep/sdf/shape_field.h"

namespace sidestep::bench {
namespace {

const std::string kFloor = "floor";  // as verdicts call it; no box may have the name

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

  // Against one thing, as it stands at the beginning. @param path of it in the file.
  void CheckClear(const std::string& key, const Eigen::VectorXd& q, const std::string& object,
                  const std::string& path, const sdf::ShapeField& solid) const {
    const robot::SphereCenters spheres = robot_.ComputeSphereCenters(q, false);
    const std::string& stands_on = scenario_.mount.empty() ? kFloor : scenario_.mount;
    const std::vector<int>& mount_spheres = robot_.mount_spheres();
    int deepest = -1;
    double least_m = 0;
    for (int s = 0; s < robot_.num_spheres(); ++s) {
      const bool mounted = std::count(mount_spheres.begin(), mount_spheres.end(), s) > 0;
      if (mounted && object == stands_on) continue;
      const double clearance_m =
          solid.Distance(spheres.p_WS.col(s), EpisodeTime(0)) - robot_.sphere_radii_m()(s);
      if (clearance_m >= least_m) continue;
      least_m = clearance_m;
      deepest = s;
    }
    if (deepest < 0) return;
    Fail(key,
         fmt::format("the robot's sphere {} is {:.1f} mm inside '{}'", deepest, -1e3 * least_m,
                     object),
         {path, "robot"});
  }

  // A horizon is lengthened to what the direct motion takes: slower and slower, that is no horizon.
  void CheckHorizon() const {
    const double horizon_s = HorizonOf(scenario_, robot_);
    const double steps = std::round(horizon_s / scenario_.step_s);
    if (horizon_s <= scenarios::kMostHorizon_s && steps <= scenarios::kMostHorizonSteps) return;
    Fail("horizon.duration_s",
         fmt::format("is too little: within the limits that are asked for, the direct motion takes "
                     "{:.1f} s, {:.0f} steps; the most are {} s and {} steps",
                     horizon_s, steps, scenarios::kMostHorizon_s, scenarios::kMostHorizonSteps),
         {"planner.velocity_scale", "planner.acceleration_scale", "safety.tool_speed_m_s",
          "horizon.step_s", "robot.model"});
  }

 private:
  // @param against what else may be wrong instead.
  [[noreturn]] void Fail(const std::string& key, const std::string& why,
                         const std::vector<std::string>& against = {"robot.model"}) const {
    throw scenarios::WrongValue(scenario_, key, why, against);
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
  const auto check_both = [&](const std::string& object, const std::string& path,
                              const sdf::ShapeField& solid) {
    check.CheckClear("task.start", scenario.q_start, object, path, solid);
    check.CheckClear("task.goal", scenario.q_goal, object, path, solid);
  };
  check_both(kFloor, "floor_m", sdf::ShapeField(StaticSolids{{}, {FloorOf(scenario)}}));
  for (const scenarios::StaticObstacle& fixed : scenario.static_obstacles) {
    check_both(fixed.name, fixed.path,
               sdf::ShapeField(StaticSolids{{{fixed.shape, fixed.X_WO}}, {}}));
  }
  const std::vector<sdf::MovingShape> motions = TrueMotions(scenario);
  for (std::size_t n = 0; n < motions.size(); ++n) {
    check.CheckClear("task.start", scenario.q_start, scenario.moving_obstacles[n].name,
                     "moving_obstacles[" + std::to_string(n) + "]",
                     sdf::ShapeField({}, {motions[n]}));
  }
  check.CheckHorizon();
}

}  // namespace sidestep::bench
