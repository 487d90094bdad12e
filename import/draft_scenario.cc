#include "sidestep/import/draft_scenario.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/import/free_space.h"
#include "sidestep/import/inverse_kinematics.h"

namespace sidestep::imports {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kReachSamples = 3000;
constexpr int kCellsAcross = 48;  // of the longest side, some
constexpr int kMostTries = 3000, kEnoughGoals = 12;
constexpr int kWaySteps = 24;
constexpr double kFree_m = 0.03;

// Of a polynomial of fifth order over a unit of way and time.
constexpr double kPeakSpeed = 1.875, kPeakAcceleration = 5.7735;

struct Bounds {
  Vector3d low_W = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high_W = -low_W;
};

// Of all spheres at many configurations.
Bounds ReachedBounds(const robot::RobotModel& robot) {
  RandomStream random(1, "reach");
  Bounds bounds;
  for (int n = 0; n < kReachSamples; ++n) {
    const Eigen::Matrix3Xd p_WS =
        robot.ComputeSphereCenters(RandomConfiguration(robot, random), false).p_WS;
    for (int s = 0; s < robot.num_spheres(); ++s) {
      const Vector3d radius = Vector3d::Constant(robot.sphere_radii_m()(s));
      bounds.low_W = bounds.low_W.cwiseMin(p_WS.col(s) - radius);
      bounds.high_W = bounds.high_W.cwiseMax(p_WS.col(s) + radius);
    }
  }
  return bounds;
}

// The largest of 1, 2, 4, 5 times a power of ten that is not above a length.
double RoundDown(double length_m) {
  const double power = std::pow(10.0, std::floor(std::log10(length_m)));
  double rounded = power;
  for (const double digit : {2.0, 4.0, 5.0}) {
    if (digit * power <= length_m * (1 + 1e-9)) rounded = digit * power;
  }
  return rounded;
}

GridSpec WorkspaceAround(const Bounds& bounds) {
  const Vector3d size = bounds.high_W - bounds.low_W;
  const double margin_m = 0.15 * size.maxCoeff();
  const double cell_m = std::clamp(RoundDown(size.maxCoeff() / kCellsAcross), 0.001, 10.0);
  GridSpec grid;
  grid.cell_m = cell_m;
  for (int axis = 0; axis < 3; ++axis) {
    const double first = std::floor((bounds.low_W(axis) - margin_m) / cell_m);
    const double last = std::ceil((bounds.high_W(axis) + margin_m) / cell_m);
    grid.first_center_m(axis) = std::round(1e6 * first * cell_m) / 1e6;
    grid.size[static_cast<std::size_t>(axis)] =
        static_cast<int>(std::clamp(last - first + 1, 2.0, 512.0));
  }
  return grid;
}

double WayClearance(const FreeSpace& space, const VectorXd& q_from, const VectorXd& q_to) {
  double least_m = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= kWaySteps; ++step) {
    const double share = static_cast<double>(step) / kWaySteps;
    least_m = std::min(least_m, space.Clearance(q_from + share * (q_to - q_from)));
  }
  return least_m;
}

// What is wanted of clearance: of a robot that is always near something, such as a carriage on its
// rail near the floor, half of what it has at best.
double WantedClearance(const FreeSpace& space, const robot::RobotModel& robot) {
  RandomStream random(1, "clearance");
  double most_m = 0;
  for (int n = 0; n < 500 && most_m < 2 * kFree_m; ++n) {
    most_m = std::max(most_m, space.Clearance(RandomConfiguration(robot, random)));
  }
  return std::min(kFree_m, most_m / 2);
}

// The way of the sphere that goes farthest [m].
double SphereTravel(const robot::RobotModel& robot, const VectorXd& q_from, const VectorXd& q_to) {
  const Eigen::Matrix3Xd from = robot.ComputeSphereCenters(q_from, false).p_WS;
  const Eigen::Matrix3Xd to = robot.ComputeSphereCenters(q_to, false).p_WS;
  return (to - from).colwise().norm().maxCoeff();
}

// Numbers that a person reads.
VectorXd RoundedJoints(const VectorXd& q) { return (1e3 * q).array().round() / 1e3; }

}  // namespace

scenarios::Scenario DraftScenario(const robot::RobotModel& robot) {
  scenarios::Scenario scenario;
  scenario.robot = robot.name();
  scenario.X_WB = robot.X_WB();
  scenario.grid = WorkspaceAround(ReachedBounds(robot));
  scenario.static_world = scenarios::StaticWorld::kExact;
  scenario.horizon_s = 3;
  scenario.step_s = 0.1;
  scenario.planner = "gpmp_fast";
  scenario.epsilon_m = std::round(100 * std::clamp(0.12 * ReachOf(robot), 0.01, 0.15)) / 100;
  scenario.velocity_scale = 0.95;
  scenario.acceleration_scale = 0.5;
  scenario.growth_limit_m = 0.1;
  scenario.knowledge = "prediction";
  scenario.predictor = "kalman_cv";
  scenario.replan_rate_hz = 10;
  scenario.latency_s = 0.1;
  scenario.sensor.name = "occupancy";
  scenario.sensor.rate_hz = 30;
  return scenario;
}

double ReachOf(const robot::RobotModel& robot) {
  const Bounds bounds = ReachedBounds(robot);
  const Vector3d base = robot.X_WB().translation();
  return (bounds.high_W - base).cwiseMax(base - bounds.low_W).maxCoeff();
}

double DirectDuration_s(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        const VectorXd& q_from, const VectorXd& q_to) {
  double duration_s = 0;
  for (int i = 0; i < robot.num_joints(); ++i) {
    const robot::JointLimits& limits = robot.limits()[static_cast<std::size_t>(i)];
    const double way = std::abs(q_to(i) - q_from(i));
    duration_s = std::max(
        {duration_s, kPeakSpeed * way / (scenario.velocity_scale * limits.v_max),
         std::sqrt(kPeakAcceleration * way / (scenario.acceleration_scale * limits.a_max))});
  }
  return duration_s;
}

void FitHorizon(scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  const double direct_s = DirectDuration_s(scenario, robot, scenario.q_start, scenario.q_goal);
  scenario.horizon_s = std::clamp(std::ceil(2 * 1.5 * direct_s) / 2, 2.0, 60.0);
  scenario.step_s = scenario.horizon_s > 10 ? scenario.horizon_s / 100 : 0.1;
}

bool ChooseGoal(scenarios::Scenario& scenario, const robot::RobotModel& robot, RandomStream& random,
                const IsGood& is_good) {
  const FreeSpace space(scenario, robot);
  const double wanted_m = 0.6 * ReachOf(robot), clearance_m = WantedClearance(space, robot);
  double best = std::numeric_limits<double>::infinity();
  int num_found = 0;
  for (int n = 0; n < kMostTries && num_found < kEnoughGoals; ++n) {
    const VectorXd any = RandomConfiguration(robot, random);
    const VectorXd q =
        RoundedJoints(scenario.q_start + random.Uniform(0.2, 0.7) * (any - scenario.q_start));
    const double off_m = std::abs(SphereTravel(robot, scenario.q_start, q) - wanted_m);
    if (off_m >= best || WayClearance(space, scenario.q_start, q) < clearance_m) continue;
    if (!is_good(q)) continue;
    ++num_found;
    best = off_m;
    scenario.q_goal = q;
  }
  scenario.goal_name.clear();
  return num_found > 0;
}

bool ChooseTask(scenarios::Scenario& scenario, const robot::RobotModel& robot, RandomStream& random,
                const IsGood& is_good) {
  const FreeSpace space(scenario, robot);
  const double clearance_m = WantedClearance(space, robot);
  std::vector<std::string> names = {"ready", "home"};
  for (const auto& [name, q] : robot.configurations()) names.push_back(name);
  for (const std::string& name : names) {
    const auto found = robot.configurations().find(name);
    if (found == robot.configurations().end()) continue;
    if (space.Clearance(found->second) < clearance_m || !is_good(found->second)) continue;
    scenario.start_name = name;
    scenario.q_start = found->second;
    if (ChooseGoal(scenario, robot, random, is_good)) return true;
  }
  scenario.start_name.clear();
  for (int n = 0; n < kMostTries; ++n) {
    const VectorXd q = RoundedJoints(RandomConfiguration(robot, random));
    if (space.Clearance(q) < clearance_m || !is_good(q)) continue;
    scenario.q_start = q;
    if (ChooseGoal(scenario, robot, random, is_good)) return true;
  }
  return false;
}

void AddCrossingBall(scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  const VectorXd &q_start = scenario.q_start, &q_goal = scenario.q_goal;
  const double reach_m = ReachOf(robot);
  const double direct_s = DirectDuration_s(scenario, robot, q_start, q_goal);
  const auto centers = [&](const VectorXd& q) { return robot.ComputeSphereCenters(q, false).p_WS; };
  const Eigen::Matrix3Xd at_start = centers(q_start), at_goal = centers(q_goal);
  const Eigen::Matrix3Xd midway = centers((q_start + q_goal) / 2);
  Eigen::Index farthest;
  (at_goal - at_start).colwise().norm().maxCoeff(&farthest);
  scenarios::MovingObstacle ball;
  ball.name = "flying_ball";
  const double radius_m = std::round(1e3 * std::clamp(0.1 * reach_m, 0.01, 0.12)) / 1e3;
  ball.shape = Sphere{radius_m};
  ball.rpy_rad = Vector3d::Zero();
  Vector3d crossing = midway.col(farthest);
  crossing.z() = std::max(crossing.z(), scenario.floor_m + 1.2 * radius_m);

  std::optional<scenarios::LinearMotion> best;
  double best_m = -std::numeric_limits<double>::infinity();
  constexpr int kDirections = 24;
  for (int n = 0; n < kDirections; ++n) {
    for (const double share : {0.35, 0.5, 0.7}) {  // of the reach, a second
      const double angle = 2 * std::numbers::pi * n / kDirections;
      scenarios::LinearMotion motion;
      motion.direction = {std::round(1e3 * std::cos(angle)) / 1e3,
                          std::round(1e3 * std::sin(angle)) / 1e3, 0};
      motion.direction.normalize();
      motion.speed_m_s = std::round(100 * std::max(share * reach_m, 0.01)) / 100;
      motion.start_m = crossing - motion.speed_m_s * direct_s / 2 * motion.direction;
      motion.start_m = (1e3 * motion.start_m).array().round() / 1e3;
      motion.stop_at_s = std::numeric_limits<double>::infinity();
      // How far it stays from the arm before that has begun, and after it has arrived.
      double least_m = std::numeric_limits<double>::infinity();
      for (double t = 0; t <= 3 * direct_s; t += direct_s / 50) {
        if (t > 0.25 * direct_s && t < direct_s) continue;
        const Vector3d p = motion.start_m + motion.speed_m_s * t * motion.direction;
        const Eigen::Matrix3Xd& arm = t < direct_s ? at_start : at_goal;
        for (int s = 0; s < robot.num_spheres(); ++s) {
          const double gap_m = (arm.col(s) - p).norm() - robot.sphere_radii_m()(s) - radius_m;
          least_m = std::min(least_m, gap_m);
        }
      }
      if (least_m <= best_m) continue;
      best_m = least_m;
      best = motion;
    }
  }
  ball.motion = best.value();
  scenario.moving_obstacles.push_back(ball);
}

}  // namespace sidestep::imports
