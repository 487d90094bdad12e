#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"

// What the parts of a closed loop tell of themselves, sample by sample.
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
  EpisodeTime t;          ///< when the world was observed
  EpisodeTime t_effect;   ///< when its plan took (or would have taken) effect
  std::string status;     ///< of the planner
  std::string reason;     ///< why there is no plan; else empty
  bool accepted = false;  ///< whether the plan was given to the robot
  int iterations = 0;     ///< of the optimiser
  /// Its budget was spent before all was tried that there was to try: without one it would have
  /// gone on, and been late.
  bool cut_short = false;
  double cost = 0;                   ///< final, of the whole objective
  double predicted_clearance_m = 0;  ///< least along the plan, in the predicted field
  int samples_outside_grid = 0;      ///< positions of spheres along the plan that no map covers
  EpisodeTime plan_start;            ///< the plan's state k is at plan_start + plan.t_s(k)
  Trajectory plan;
  std::vector<PredictedObject> objects;
};

/// What a robot's safety supervisor found, when it began to find it.
struct SafetyEvent {
  EpisodeTime t;
  std::string check, reaction;  ///< words of control/safety.h
  double value = 0, limit = 0;  ///< what was measured, and what it may be, in the check's unit
};

/// What tracking noticed about a thing, when it noticed it.
struct TrackEvent {
  EpisodeTime t;     ///< of the scan
  std::string what;  ///< a word of sdf/tracking/object_tracker.h
  int id = 0;        ///< of the thing
  int other_id = 0;  ///< of the other one in a merge or a split; 0: none
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< [m] where it is thought to be
};

}  // namespace sidestep
