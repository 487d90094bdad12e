#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "core/pose.h"
#include "core/time.h"
#include "core/trajectory.h"

namespace sidestep {

/// One control tick of a robot: what it was told and what it did. All vectors have shape n.
struct ControlSample {
  EpisodeTime t;
  Eigen::VectorXd q_command;  ///< rad
  Eigen::VectorXd v_command;  ///< rad/s
  Eigen::VectorXd a_command;  ///< rad/s^2
  Eigen::VectorXd q;          ///< measured, rad
  Eigen::VectorXd v;          ///< measured, rad/s
  Eigen::VectorXd torque;     ///< applied by the motors, N m
};

inline constexpr double kNoContact = std::numeric_limits<double>::quiet_NaN();

/// What was true of the world at one moment, judged by geometry and physics.
struct TruthSample {
  EpisodeTime t;
  /// Least distance between the robot and anything it may not touch [m]; negative: penetration.
  double clearance_m = 0;
  std::string nearest_robot_part;  ///< the pair that is nearest
  std::string nearest_object;
  bool in_contact = false;        ///< touched at any physics step since the previous sample
  double contact_s = kNoContact;  ///< episode time of the first of those steps; NaN: none
  std::string contact_object;     ///< which object, empty without a contact
  Eigen::Vector3d p_WContact = Eigen::Vector3d::Zero();  ///< [m] where, if in_contact
  std::vector<Pose> X_WO;  ///< of each moving obstacle, in the order of Recording::obstacles
};

/// One object as it was predicted in one planning cycle: a box around it and where it would be.
struct PredictedObject {
  int id = 0;
  Eigen::Vector3d half_extents_m = Eigen::Vector3d::Zero();
  std::vector<EpisodeTime> t;
  std::vector<Pose> X_WO;  ///< as many as t; O is the centre of the box
};

/// One planning cycle.
struct CycleRecord {
  EpisodeTime t;                     ///< when the world was observed
  EpisodeTime t_effect;              ///< when its plan took (or would have taken) effect
  std::string status;                ///< of the planner
  bool accepted = false;             ///< whether the plan was given to the robot
  int iterations = 0;                ///< of the optimiser
  double cost = 0;                   ///< final, of the whole objective
  double predicted_clearance_m = 0;  ///< least along the plan, in the predicted field
  EpisodeTime plan_start;            ///< the plan's state k is at plan_start + plan.t_s(k)
  Trajectory plan;
  std::vector<PredictedObject> objects;
};

/// What tracking noticed about a thing, when it noticed it.
struct TrackEvent {
  EpisodeTime t;     ///< of the scan
  std::string what;  ///< a word of sdf/tracking/object_tracker.h
  int id = 0;        ///< of the thing
  int other_id = 0;  ///< of the other one in a merge or a split; 0: none
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m] where it is thought to be
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
  Eigen::VectorXd v_max;               ///< the robot's velocity limits, rad/s
  std::vector<ControlSample> control;  ///< at the control rate
  std::vector<TruthSample> truth;      ///< at 100 Hz
  std::vector<ObservationRecord> observations;
  std::vector<CycleRecord> cycles;
  std::vector<TrackEvent> events;         ///< of prediction only, in order
  std::map<std::string, double> metrics;  ///< of this episode; NaN where one does not apply
};

/// Version of the HDF5 library, e.g. "1.10.8".
std::string Hdf5Version();

/// Writes `recording` as HDF5 (layout: docs/trace.md). Equal recordings give equal bytes.
/// @throws InputError if the file cannot be written.
void WriteRecording(const Recording& recording, const std::string& path);

/// Reads it back. @throws InputError, naming the file and what is wrong, if the file is missing,
/// not HDF5, cut off, or not a recording of this version.
Recording ReadRecording(const std::string& path);

}  // namespace sidestep
