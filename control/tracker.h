#pragma once

#include <Eigen/Core>

#include "sidestep/control/joint_motion.h"
#include "sidestep/control/joint_vector.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::control {

/// Bounds of the commanded motion, per joint. All but v_max may be infinite; the tracker then stays
/// within 100/s v_max of acceleration and 300/s a_max of jerk.
struct TrackerLimits {
  Eigen::VectorXd q_min, q_max;            ///< q_min < q_max
  Eigen::VectorXd v_max, a_max, jerk_max;  ///< all > 0
  /// Fractions of a robot's limits; the defaults follow common practice on a Panda.
  static TrackerLimits Of(const robot::RobotModel& robot, double v_scale = 1.0,
                          double a_scale = 1.0, double jerk_scale = 0.5);
};

/// Turns a trajectory, whose acceleration jumps and which may be replaced at any time, into a
/// command whose jerk, acceleration and velocity stay within limits at every tick; the same in
/// simulation and on hardware. It keeps no state: each tick starts from the motion that the robot
/// says it was last told, so a lost command makes no jump. Joints are independent of one another.
/// Nothing is allocated, and a tick takes a bounded time.
///
/// The limits bind the sent samples: position, and its first, second and third backward difference
/// over one tick, which is how a Panda's controller judges what it is sent.
class JerkLimitedTracker {
 public:
  /// @throws std::invalid_argument for more than kMaxJoints joints, a limit <= 0, q_min >= q_max,
  /// an infinite v_max, or vectors of different lengths.
  explicit JerkLimitedTracker(const TrackerLimits& limits);

  int num_joints() const { return num_joints_; }
  /// Of joint j, without infinities but of position.
  const JointBounds& bounds(int j) const { return bounds_[static_cast<std::size_t>(j)]; }

  /// The tick after `state`, towards `target`, which is the point at the time of the command that
  /// comes back. From a state that was reached by this tracker no sent sample ever breaks a limit;
  /// what cannot be followed within them is followed late, without overshooting a position limit.
  /// Another state, from which no stop keeps to the limits, is braked; a joint at rest beyond its
  /// range may move towards it only. Small errors die out with a triple pole at 100 rad/s; the
  /// target's velocity and acceleration are fed forward.
  /// @param state, target finite, of num_joints(). @param period_s the tick, > 0, e.g. 0.001.
  JointPoint Step(const JointPoint& state, const JointPoint& target,
                  double period_s) const noexcept;

  /// The tick after `state` of the quickest stop within the limits; at rest it stays.
  JointPoint Brake(const JointPoint& state, double period_s) const noexcept;

 private:
  template <class Acceleration>
  JointPoint Advance(const JointPoint& state, double period_s,
                     const Acceleration& acceleration) const noexcept;

  int num_joints_;
  JointBounds bounds_[kMaxJoints];
};

}  // namespace sidestep::control
