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

/// The stop that BrakeAcceleration takes tick by tick, in closed form: a few phases of constant
/// jerk or acceleration, each a whole number of ticks.
class JointStop {
 public:
  JointStop(const JointMotion& motion, const JointBounds& bounds, double period_s);

  double ticks() const { return ticks_; }  ///< until it rests
  /// Where it is after that many ticks, a whole number >= 0.
  double PositionAfter(double ticks) const;

  double q_end() const { return q_end_; }  ///< where it rests
  double q_least() const { return q_least_; }
  double q_most() const { return q_most_; }  ///< of the whole way, its beginning included
  double v_most() const { return v_most_; }  ///< the largest speed on the way, beginning included

 private:
  // Ticks whose accelerations are a + s, a + 2 s, ...
  struct Phase {
    double ticks, q, v, a, s;
  };
  static constexpr int kMaxPhases = 6;

  void Note(double q, double v);
  void Add(double ticks, double a, double s);
  void EaseOff();
  void Press();
  void Hold();
  void Land();

  double h_, a_max_, jerk_, reach_;
  double direction_ = 1;  // of the motion that is being stopped: in it, v_ >= 0 between phases
  double q_, v_, a_;      // after the phases so far, in that direction
  Phase phases_[kMaxPhases];
  int num_phases_ = 0;
  double ticks_ = 0, q_end_, q_least_, q_most_, v_most_;
};

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
