#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::render {

/// The world of one recording, which can be set to any of its moments. Nothing is simulated: joints
/// and obstacles are put where the recording says they were.
class TraceModel {
 public:
  /// Keeps a reference to `recording`, which must outlive it.
  /// @param name stands for the recording in messages.
  /// @throws InputError if there is nothing to draw, or model and recording do not fit together.
  TraceModel(const record::Recording& recording, const std::string& name);

  void MoveTo(EpisodeTime t);

  const record::Recording& recording() const { return recording_; }
  const std::string& name() const { return name_; }
  mjModel& model() { return *model_; }
  const mjModel& model() const { return *model_; }
  mjData& data() { return *data_; }
  const mjData& data() const { return *data_; }

  bool IsRobot(int geom) const;  ///< the geom belongs to the robot
  /// The obstacle (its place in Recording::obstacles) that a geom belongs to, or -1.
  int ObstacleOf(int geom) const;
  /// Whether a geom belongs to the object that the recording calls by this name.
  bool BelongsTo(int geom, const std::string& object) const;

  static constexpr double kTrailStep_s = 0.01, kPlanStep_s = 0.02;

  /// Where the tip of the arm was, every kTrailStep_s from the first control sample until `t`
  /// (3 x N, m).
  Eigen::Matrix3Xd TipTrail(EpisodeTime t) const;
  /// Where the tip will be from `t` to the plan's end, every kPlanStep_s, and at its end (3 x N,
  /// m); empty if it is over. Leaves the model at another moment: call MoveTo again.
  Eigen::Matrix3Xd TipPlan(const CycleRecord& cycle, EpisodeTime t);

 private:
  void SetJoints(const Eigen::VectorXd& q);
  Eigen::Vector3d TipPosition() const;
  void FindTip();
  void RecordTrail();

  const record::Recording& recording_;
  std::string name_;
  sim::MujocoModelPtr model_;
  sim::MujocoDataPtr data_;
  std::vector<int> joint_addresses_;  // of each joint, in qpos
  std::vector<int> obstacle_bodies_;  // of each obstacle
  int robot_root_ = 0;                // the robot's body below the world
  int tip_site_ = -1;                 // the tip of the arm: a site, or if there is none ...
  int tip_body_ = 0;                  // ... a body
  Eigen::Matrix3Xd trail_;
};

}  // namespace sidestep::render
