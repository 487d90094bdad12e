#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/time.h"

namespace sidestep::record {

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Limits of a motion, each of shape n, infinite where there is none.
struct MotionLimits {
  Eigen::VectorXd v_max, a_max, jerk_max, torque_rate_max;  ///< rad/s, rad/s^2, rad/s^3, N m/s
};

/// A named object as a sensor reported it.
struct SeenObject {
  std::string id;
  Pose X_WO;
  /// Of position (x, y, z in W) and rotation vector, m and rad.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// One scan as it was told to the planner's model of the world.
struct ObservationRecord {
  EpisodeTime t;          ///< of its capture
  EpisodeTime t_arrival;  ///< when the loop had it
  /// The cells of the workspace (GridSpec::Index, ascending) that it says are filled when the scan
  /// before said free, or the other way round; before the first, everything is free.
  std::vector<std::int64_t> changed_cells;
  std::vector<SeenObject> objects;
};

/// Everything of one episode: enough to draw it and to judge it again without running it. Holds no
/// wall-clock figure, so that equal runs give equal bytes.
struct Recording {
  /// Facts of the run: scenario, robot, planner, knowledge, seed, versions, ... ; all text.
  std::map<std::string, std::string> header;
  std::string scenario_yaml;           ///< the scenario as run, overrides applied
  std::string model_xml;               ///< MJCF of the whole world
  std::vector<std::string> joints;     ///< n names, as in the MJCF
  std::vector<std::string> obstacles;  ///< mocap bodies, as in the MJCF
  Eigen::VectorXd q_start;
  Eigen::VectorXd q_goal;
  double dwell_s = 0;  ///< how long the arm had to stay at its goal
  /// What one rad of a tolerance is for each joint, in its own unit; empty where all turn.
  Eigen::VectorXd tolerance_scale;
  MotionLimits robot_limits;  ///< the robot's own
  /// What the motion was to keep to, as asked for: the robot's times the scenario's scales.
  MotionLimits limits;
  double tool_a_max = kNoLimit;        ///< [m/s^2] what the robot's tool must not exceed
  double tool_a_reflex = kNoLimit;     ///< [m/s^2] above it the robot is known to stop by itself
  std::vector<ControlSample> control;  ///< at the control rate
  /// [m] where each command puts the tool, in W: one a control sample, or none where nobody knows.
  std::vector<Eigen::Vector3d> p_WTool;
  std::vector<TruthSample> truth;  ///< at 100 Hz
  std::vector<ObservationRecord> observations;
  std::vector<CycleRecord> cycles;
  std::vector<TrackEvent> events;         ///< of prediction only, in order
  std::vector<SafetyEvent> safety;        ///< of the robot's supervisor, in order
  std::map<std::string, double> metrics;  ///< of this episode; NaN where one does not apply
};

}  // namespace sidestep::record
