#pragma once

namespace sidestep::control {

/// Bounds of one joint's commanded motion.
struct JointBounds {
  double q_min, q_max, v_max, a_max, jerk_max;
};

/// One joint at one tick.
struct JointMotion {
  double q, v, a;

  /// The next tick, if its acceleration is `a_next`. Backward Euler throughout, so that v and a are
  /// exactly the backward differences of the positions sent.
  JointMotion Next(double a_next, double period_s) const {
    const double v_next = v + period_s * a_next;
    return {q + period_s * v_next, v_next, a_next};
  }
};

/// The acceleration of the next tick on the quickest way to rest (v = 0, a = 0) within the
/// acceleration and jerk limits. It arrives exactly, and at rest it is 0.
double BrakeAcceleration(const JointMotion& motion, const JointBounds& bounds, double period_s);

/// Where the stop leads that BrakeAcceleration takes tick by tick, in closed form: a few phases of
/// constant jerk or acceleration, each a whole number of ticks, whatever their number.
struct StopSummary {
  double q_end;            ///< where it rests
  double q_least, q_most;  ///< reached on the way, `motion` itself included
  double v_most;           ///< the largest speed on the way, `motion` itself included
};
StopSummary SummarizeStop(const JointMotion& motion, const JointBounds& bounds, double period_s);

/// Whether that quickest stop, begun at `motion`, keeps to the position and velocity limits all the
/// way, `motion` itself included.
bool CanStopWithin(const JointMotion& motion, const JointBounds& bounds, double period_s);

/// The acceleration of the next tick that is nearest to `wanted` among those that keep every limit,
/// now and for ever. Why it always exists:
///
/// Call a motion safe if CanStopWithin. From a safe motion, the tick that BrakeAcceleration gives
/// leads to the next motion of the very stop that was checked, so that one is safe too. Any other
/// tick is taken only after the motion it leads to was itself found safe. Rest within the position
/// limits is safe. So by induction every motion is safe, and a safe motion is within its limits.
/// The closed form and the ticks round differently, by far less than a reserve (a nanorad, and
/// 1e-12 of the speed) that is kept from position and velocity limits.
///
/// A motion that is not safe (a driver may start anywhere) is held to its own excess: it may go no
/// further beyond a limit than it is, and is braked where even that cannot be promised.
double SafeAcceleration(const JointMotion& motion, double wanted, const JointBounds& bounds,
                        double period_s);

}  // namespace sidestep::control
