#pragma once

#include <Eigen/Core>

#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::control {

/// What the motors are told in one tick. Shape n each: rad, rad/s, rad/s^2, rad/s^3. v, a and jerk
/// are the backward differences of the commanded q, v and a over one tick.
struct TrackerCommand {
  Eigen::VectorXd q, v, a, jerk;
};

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
/// command whose jerk, acceleration and velocity stay within limits at every tick. One small state
/// (q, v, a) that a robot driver can re-seed; the same in simulation and on hardware. Joints are
/// independent of one another.
///
/// The limits bind the sent samples: position, and its first, second and third backward difference,
/// which is how a Panda's controller judges what it is sent.
class JerkLimitedTracker {
 public:
  /// @param period_s the tick, e.g. 0.001. @throws std::invalid_argument for a period or a limit
  /// <= 0, q_min >= q_max, an infinite v_max, or vectors of different lengths.
  JerkLimitedTracker(const TrackerLimits& limits, double period_s);

  /// Starts from rest at q (or from a moving state). A state from which no stop keeps to the limits
  /// is accepted and braked; a joint at rest beyond its range may move towards it only.
  /// @throws std::invalid_argument for a wrong shape or a value that is not finite.
  void Reset(const Eigen::VectorXd& q);
  void Reset(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a);

  /// One tick towards `target`, the point at the time of the command that comes back. No sent
  /// sample ever breaks a limit; what cannot be followed within them is followed late, without
  /// overshooting a position limit. Small errors die out with a triple pole at 100 rad/s; the
  /// target's velocity and acceleration are fed forward.
  /// @throws std::invalid_argument for a wrong shape or a value that is not finite (and the state
  /// stays as it was); std::logic_error before the first Reset.
  TrackerCommand Step(const TrajectoryPoint& target);

  /// One tick of the quickest stop within the limits; at rest it stays.
  /// @throws std::logic_error before the first Reset.
  TrackerCommand StepBrake();

 private:
  TrackerCommand Advance(const Eigen::VectorXd& a_next);
  void CheckStarted() const;
  void CheckShape(const Eigen::VectorXd& values) const;

  TrackerLimits limits_;
  double period_s_;
  Eigen::VectorXd q_, v_, a_;
};

}  // namespace sidestep::control
