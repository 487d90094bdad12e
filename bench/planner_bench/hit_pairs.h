#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// What pairs of start and goal are drawn from.
struct HitPairOptions {
  /// Names of configurations of the robot that starts and goals are drawn around, each as likely as
  /// the others, and by how much: the standard deviation of each joint.
  std::vector<std::string> starts, goals;
  double spread_rad = 0.25;
  double least_speed_m_s = 1, most_speed_m_s = 2;  ///< of the obstacle
};

/// Tasks that need a planner, one a number: a start, a goal and an obstacle that hits the direct
/// motion between them, which nothing else is in the way of.
///
/// The scenario has one moving obstacle with a linear motion. It keeps its line and is given a
/// speed, a sense, and the moment, from a quarter to three quarters of the horizon, at which it
/// passes the robot's base. Start and goal are within the joint limits and keep 2 cm of everything
/// that stands still and of the robot itself; the obstacle keeps that distance from the start until
/// the latency has passed and from the goal where the horizon ends. What is drawn is decided by
/// seed and number alone.
/// @throws std::invalid_argument for a scenario without such an obstacle, unknown configurations,
/// or where 10000 draws give no task.
scenarios::Scenario MakeHitPair(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                                const HitPairOptions& options, std::uint64_t seed, int number);

}  // namespace sidestep::bench
