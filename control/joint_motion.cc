#include "sidestep/control/joint_motion.h"

#include <algorithm>
#include <cmath>

namespace sidestep::control {
namespace {

// The deceleration d of the next tick after which the speed v >= 0, with the deceleration taken
// back by jerk h each tick, ends at zero together with it. With h the tick, J the jerk and n the
// number of ticks in which the joint still moves, the decelerations are d, d - J h, ..., so
//   v = h (n d - J h n (n - 1) / 2),   (n - 1) J h < d <= n J h,
// and n is the whole number with J h^2 n (n - 1) / 2 < v <= J h^2 n (n + 1) / 2.
double LandingTicks(double v, double jerk, double h) {
  return std::max(1.0, std::ceil((std::sqrt(1 + 8 * v / (jerk * h * h)) - 1) / 2));
}

double LandingDeceleration(double v, double jerk, double h) {
  if (v <= 0) return 0;
  const double n = LandingTicks(v, jerk, h);
  return (v / h + jerk * h * n * (n - 1) / 2) / n;
}

// The speed whose landing begins with the deceleration d: the inverse of the above.
double LandingSpeed(double d, double reach, double h) {
  const double n = std::ceil(d / reach);
  return h * (n * d - reach * n * (n - 1) / 2);
}

// A stop, followed phase by phase in the direction of the motion: v >= 0 between phases.
class StopPhases {
 public:
  StopPhases(const JointMotion& motion, const JointBounds& bounds, double h)
      : h_(h), a_max_(bounds.a_max), jerk_(bounds.jerk_max), reach_(bounds.jerk_max * h) {
    q_ = motion.q;
    v_ = motion.v;
    a_ = motion.a;
    summary_ = {q_, q_, q_, std::abs(v_)};
    if (v_ < 0 || (v_ == 0 && a_ < 0)) Turn();
  }

  StopSummary Run() {
    // A deceleration too strong for the speed cannot be taken back in time: the joint swings
    // through rest, and lands coming the other way.
    if (-a_ - reach_ > Braking(v_)) EaseOff();
    if (v_ < 0) Turn();
    Press();
    Hold();
    Land();
    summary_.q_end = direction_ * q_;
    return summary_;
  }

 private:
  void Turn() {
    direction_ = -direction_;
    q_ = -q_;
    v_ = -v_;
    a_ = -a_;
  }

  double Braking(double v) const { return std::min(a_max_, LandingDeceleration(v, jerk_, h_)); }

  // The speed after k ticks whose accelerations are a + s, a + 2 s, ...
  double SpeedAfter(double k, double s) const { return v_ + h_ * (k * a_ + s * k * (k + 1) / 2); }

  void Ramp(double k, double s) {
    q_ += h_ * (k * v_ + h_ * (a_ * k * (k + 1) / 2 + s * k * (k + 1) * (k + 2) / 6));
    v_ = SpeedAfter(k, s);
    a_ += k * s;
    Note();
  }

  void Note() {
    const double q = direction_ * q_;
    summary_.q_least = std::min(summary_.q_least, q);
    summary_.q_most = std::max(summary_.q_most, q);
    summary_.v_most = std::max(summary_.v_most, std::abs(v_));
  }

  // The first k in [0, last] for which `holds`, which stays true once it is; `last` if none before.
  template <class Predicate>
  static double First(double last, const Predicate& holds) {
    double low = 0, high = last;
    while (low < high) {
      const double middle = std::floor((low + high) / 2);
      if (holds(middle)) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return high;
  }

  // Less deceleration by a full reach each tick, until it is what the speed asks for, or the joint
  // has swung through rest.
  void EaseOff() {
    const double last = std::ceil(-a_ / reach_);
    const auto is_over = [&](double k) {
      const double v = SpeedAfter(k, reach_);
      return v < 0 || -(a_ + k * reach_) - reach_ <= Braking(v);
    };
    const double ticks = First(last, is_over);
    // The furthest point is reached with the last tick of v >= 0.
    if (ticks >= 1 && SpeedAfter(ticks, reach_) < 0) {
      Ramp(ticks - 1, reach_);
      Ramp(1, reach_);
    } else {
      Ramp(ticks, reach_);
    }
  }

  // More deceleration by a full reach each tick, until it is what the speed asks for.
  void Press() {
    const double last = std::max(0.0, std::ceil((a_ + a_max_) / reach_) + 1);
    const auto is_over = [&](double k) {
      const double next = reach_ - (a_ - k * reach_);  // the strongest deceleration of tick k + 1
      if (next >= a_max_) return true;
      const double v = SpeedAfter(k, -reach_);
      return v <= 0 ? next >= 0 : next > 0 && v <= LandingSpeed(next, reach_, h_);
    };
    const double ticks = First(last, is_over);
    // The speed peaks where the acceleration changes its sign.
    const double rising = std::min(ticks, std::max(0.0, std::ceil(a_ / reach_) - 1));
    summary_.v_most = std::max(summary_.v_most, SpeedAfter(rising, -reach_));
    Ramp(ticks, -reach_);
  }

  // Ticks at the full deceleration, as long as the speed asks for it.
  void Hold() {
    if (!(v_ > 0)) return;
    const double landing = LandingSpeed(a_max_, reach_, h_);
    if (v_ < landing) return;
    const double k = std::floor((v_ - landing) / (h_ * a_max_)) + 1;
    q_ += h_ * (k * v_ - h_ * a_max_ * k * (k + 1) / 2);
    v_ -= k * h_ * a_max_;
    a_ = -a_max_;
    Note();
  }

  void Land() {
    if (v_ > 0) {
      const double n = LandingTicks(v_, jerk_, h_);
      const double d = (v_ / h_ + reach_ * n * (n - 1) / 2) / n;
      q_ += h_ * (n * v_ - h_ * (d * n * (n + 1) / 2 - reach_ * (n - 1) * n * (n + 1) / 6));
      v_ = 0;
      Note();
    }
  }

  double h_, a_max_, jerk_, reach_;
  double direction_ = 1, q_, v_, a_;
  StopSummary summary_;
};

constexpr double kPositionReserve = 1e-9;
constexpr double kSpeedReserve = 1e-12;  // relative

}  // namespace

double BrakeAcceleration(const JointMotion& motion, const JointBounds& bounds, double period_s) {
  const double deceleration =
      std::min(bounds.a_max, LandingDeceleration(std::abs(motion.v), bounds.jerk_max, period_s));
  const double reach = bounds.jerk_max * period_s;
  return std::clamp(std::copysign(deceleration, -motion.v), motion.a - reach, motion.a + reach);
}

StopSummary SummarizeStop(const JointMotion& motion, const JointBounds& bounds, double period_s) {
  return StopPhases(motion, bounds, period_s).Run();
}

bool CanStopWithin(const JointMotion& motion, const JointBounds& bounds, double period_s) {
  const StopSummary stop = SummarizeStop(motion, bounds, period_s);
  return stop.q_least >= bounds.q_min && stop.q_most <= bounds.q_max && stop.v_most <= bounds.v_max;
}

double SafeAcceleration(const JointMotion& motion, double wanted, const JointBounds& bounds,
                        double period_s) {
  JointBounds held = bounds;
  held.q_min = std::min(bounds.q_min + kPositionReserve, motion.q);
  held.q_max = std::max(bounds.q_max - kPositionReserve, motion.q);
  held.v_max = std::max(bounds.v_max * (1 - kSpeedReserve), std::abs(motion.v));

  const double reach = bounds.jerk_max * period_s;
  const double within = std::clamp(wanted, -bounds.a_max, bounds.a_max);
  double unsafe = std::clamp(within, motion.a - reach, motion.a + reach);
  if (CanStopWithin(motion.Next(unsafe, period_s), held, period_s)) return unsafe;

  double safe = BrakeAcceleration(motion, bounds, period_s);
  constexpr int kHalvings = 20;  // to a millionth of the tick's reach
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (safe + unsafe) / 2;
    (CanStopWithin(motion.Next(middle, period_s), held, period_s) ? safe : unsafe) = middle;
  }
  return safe;
}

}  // namespace sidestep::control
