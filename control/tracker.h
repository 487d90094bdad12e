#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/trajectory.h"
#include "robot/robot_model.h"

namespace sidestep {

/// What the motors are told in one tick. Shape n each: rad, rad/s, rad/s^2, rad/s^3.
struct TrackerCommand {
  Eigen::VectorXd q, v, a, jerk;
};

/// Bounds of the commanded motion, per joint.
struct TrackerLimits {
  Eigen::VectorXd q_min, q_max;
  Eigen::VectorXd v_max, a_max, jerk_max;  ///< all > 0
  /// Fractions of a robot's limits; the defaults follow common practice on a Panda.
  static TrackerLimits Of(const RobotModel& robot, double v_scale = 1.0, double a_scale = 1.0,
                          double jerk_scale = 0.5);
};

/// Turns a trajectory, whose acceleration jumps and which may be replaced at any time, into a
/// command whose jerk, acceleration and velocity stay within limits at every tick. One small state
/// (q, v, a) that a robot driver can re-seed; the same in simulation and on hardware.
class JerkLimitedTracker {
 public:
  /// @param period_s the tick, e.g. 0.001. @throws std::invalid_argument for limits <= 0.
  JerkLimitedTracker(const TrackerLimits& limits, double period_s);

  /// Starts from rest at q (or from a moving state).
  void Reset(const Eigen::VectorXd& q);
  void Reset(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a);

  /// One tick towards `target`. No sent sample ever breaks a limit; what cannot be followed within
  /// them is followed late, without overshooting a position limit.
  TrackerCommand Step(const TrajectoryPoint& target);

  /// One tick of the quickest stop within the limits; at rest it stays.
  TrackerCommand StepBrake();

 private:
  TrackerLimits limits_;
  double period_s_;
  Eigen::VectorXd q_, v_, a_;
};

}  // namespace sidestep
