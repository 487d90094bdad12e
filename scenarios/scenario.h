#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/grid.h"
#include "core/pose.h"
#include "core/shape.h"
#include "core/time.h"

namespace sidestep {

/// A body that never moves: a box.
struct StaticBox {
  std::string name;
  Pose X_WO;
  Eigen::Vector3d size_m;
};

/// Straight on from `start_m`, along a unit vector, at a speed; for good or until `stop_at_s`.
struct LinearMotion {
  Eigen::Vector3d start_m;
  Eigen::Vector3d direction;  ///< unit length
  double speed_m_s = 0;       ///< >= 0
  double stop_at_s = 0;       ///< infinite: never stops
};
/// Straight lines from point to point at one speed; rests at the last.
struct WaypointMotion {
  std::vector<Eigen::Vector3d> points_m;  ///< at least 2, no two neighbours equal
  double speed_m_s = 0;
  double stop_at_s = 0;  ///< infinite: goes to the last point
};
using Motion = std::variant<LinearMotion, WaypointMotion>;

struct MovingObstacle {
  std::string name;
  Shape shape;              ///< what contact, clearance and occupancy use
  Eigen::Vector3d rpy_rad;  ///< fixed orientation
  Motion motion;
  std::string appearance;  ///< a body of models/ to draw inside the shape; empty: draw the shape
};

struct Scenario {
  std::string name;
  std::string description;
  std::string file;  ///< where it was read

  std::string robot;
  Pose X_WB;  ///< of the robot's base
  std::string
      mount;  ///< static box the robot stands on: its mount links may touch it; may be empty
  std::string start_name, goal_name;  ///< empty when given as joints
  Eigen::VectorXd q_start, q_goal;    ///< filled when given as joints; else looked up by the name

  double horizon_s = 0;
  double step_s = 0;
  GridSpec grid;
  double floor_m = 0;  ///< height of the floor: solid, drawn, never part of the occupancy

  std::vector<StaticBox> static_boxes;
  std::vector<MovingObstacle> moving_obstacles;

  std::string planner;
  double epsilon_m = 0, sigma_obs = 0, qc = 1;
  double velocity_scale = 1, acceleration_scale = 1;
  int num_interpolated = 0, max_iterations = 0;
  bool velocity_limits = true, acceleration_limits = true, position_limits = true;

  std::string knowledge;  ///< a word of sdf/world_model.h
  std::string predictor;
  double replan_rate_hz = 0;
  double latency_s = 0;  ///< charged to each planning cycle

  std::string sensor;
  double sensor_rate_hz = 0;
  std::uint64_t seed = 1;

  /// Lines of the values that only other modules can judge (names of robots, configurations,
  /// planners, ...), by their path in the file, so that they can complain as the reader does.
  std::map<std::string, int> lines;
};

/// Where an obstacle is at `t`. Before 0 it rests at its start.
Pose PoseAt(const MovingObstacle& obstacle, EpisodeTime t);

/// The names of all scenarios in a folder, sorted.
std::vector<std::string> ScenarioNames(const std::string& directory);

/// Reads a scenario file. @throws InputError FILE:LINE: KEY: WHY.
Scenario LoadScenario(const std::string& path);
/// The same from text; `name` stands for the file in messages.
Scenario ParseScenario(const std::string& text, const std::string& name);

/// The scenario as YAML that ParseScenario reads back to an equal value.
std::string ToYaml(const Scenario& scenario);

}  // namespace sidestep
