#pragma once

#include <limits>
#include <string>
#include <utility>

#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::sim {

inline const std::string kTestModels = SIDESTEP_SOURCE_DIR "/tests/sim/models";

/// The robot of tests/sim/models/two_link on an empty floor: base at the origin, arm level along x.
inline scenarios::Scenario TwoLinkScenario() {
  scenarios::Scenario scenario;
  scenario.name = "two_link";
  scenario.file = "two_link.yaml";
  scenario.robot = "two_link";
  scenario.q_start = Eigen::Vector2d(0, 0);
  scenario.grid = {{-1, -1, -1}, 0.04, {50, 50, 50}};
  scenario.sensor.name = "occupancy";
  scenario.sensor.rate_hz = 30;
  return scenario;
}

inline robot::RobotModel TwoLink(const scenarios::Scenario& scenario) {
  return robot::RobotModel::Load(kTestModels, "two_link", scenario.X_WB);
}

/// An obstacle that moves along a line for good.
inline scenarios::MovingObstacle Passing(std::string name, Shape shape,
                                         const Eigen::Vector3d& start_m,
                                         const Eigen::Vector3d& direction, double speed_m_s) {
  scenarios::MovingObstacle obstacle;
  obstacle.name = std::move(name);
  obstacle.shape = shape;
  obstacle.rpy_rad = Eigen::Vector3d::Zero();
  obstacle.motion = scenarios::LinearMotion{start_m, direction.normalized(), speed_m_s,
                                            std::numeric_limits<double>::infinity()};
  return obstacle;
}

}  // namespace sidestep::sim
