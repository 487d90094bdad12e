#include "sidestep/control/joint_motion.h"

#include <algorithm>
#include <cmath>

namespace sidestep::control {
namespace {

// A landing: the speed v >= 0 ends at zero together with its deceleration, which is taken back by
// jerk h each tick. With h the tick, J the jerk, d the first deceleration and n the number of ticks
// in which the joint still moves, the decelerations are d, d - J h, ..., so
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

// The first k in [0, last] for which `holds`, which stays true once it is; `last` if none before.
template <class Predicate>
double First(double last, const Predicate& holds) {
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

// Speed and way of k ticks whose accelerations are a + s, a + 2 s, ...
double SpeedAfter(double v, double a, double s, double k, double h) {
  return v + h * (k * a + s * k * (k + 1) / 2);
}
double WayAfter(double v, double a, double s, double k, double h) {
  return h * (k * v + h * (a * k * (k + 1) / 2 + s * k * (k + 1) * (k + 2) / 6));
}

constexpr double kPositionReserve = 1e-9;
constexpr double kSpeedReserve = 1e-12;  // relative

}  // namespace

double BrakeAcceleration(const JointMotion& motion, const JointBounds& bounds, double period_s) {
  const double deceleration =
      std::min(bounds.a_max, LandingDeceleration(std::abs(motion.v), bounds.jerk_max, period_s));
  const double reach = bounds.jerk_max * period_s;
  return std::clamp(std::copysign(deceleration, -motion.v), motion.a - reach, motion.a + reach);
}

JointStop::JointStop(const JointMotion& motion, const JointBounds& bounds, double period_s)
    : h_(period_s),
      a_max_(bounds.a_max),
      jerk_(bounds.jerk_max),
      reach_(bounds.jerk_max * period_s),
      q_(motion.q),
      v_(motion.v),
      a_(motion.a),
      q_end_(q_),
      q_least_(q_),
      q_most_(q_),
      v_most_(std::abs(v_)) {
  const auto turn = [this] {
    direction_ = -direction_;
    q_ = -q_;
    v_ = -v_;
    a_ = -a_;
  };
  if (v_ < 0 || (v_ == 0 && a_ < 0)) turn();
  // A deceleration too strong for the speed cannot be taken back in time: the joint swings through
  // rest, and lands coming the other way.
  EaseOff();
  if (v_ < 0) turn();
  Press();
  Hold();
  Land();
  q_end_ = direction_ * q_;
}

double JointStop::PositionAfter(double ticks) const {
  for (int i = 0; i < num_phases_; ++i) {
    const Phase& phase = phases_[i];
    if (ticks <= phase.ticks) {
      return phase.q + WayAfter(phase.v, phase.a, phase.s, ticks, h_);
    }
    ticks -= phase.ticks;
  }
  return q_end_;
}

void JointStop::Note(double q, double v) {
  q_least_ = std::min(q_least_, direction_ * q);
  q_most_ = std::max(q_most_, direction_ * q);
  v_most_ = std::max(v_most_, std::abs(v));
}

void JointStop::Add(double ticks, double a, double s) {
  if (ticks <= 0) return;
  phases_[num_phases_++] = {ticks, direction_ * q_, direction_ * v_, direction_ * a,
                            direction_ * s};
  ticks_ += ticks;
  q_ += WayAfter(v_, a, s, ticks, h_);
  v_ = SpeedAfter(v_, a, s, ticks, h_);
  a_ = a + ticks * s;
  Note(q_, v_);
}

// Less deceleration by a full reach each tick, until it is what the speed asks for, or the joint
// has swung through rest.
void JointStop::EaseOff() {
  const auto asked_for = [&](double v) {
    return std::min(a_max_, LandingDeceleration(v, jerk_, h_));
  };
  if (-a_ - reach_ <= asked_for(v_)) return;
  const auto is_over = [&](double k) {
    const double v = SpeedAfter(v_, a_, reach_, k, h_);
    return v < 0 || -(a_ + k * reach_) - reach_ <= asked_for(v);
  };
  const double ticks = First(std::ceil(-a_ / reach_), is_over);
  // The furthest point is reached with the last tick of v >= 0.
  const bool swings = ticks >= 1 && SpeedAfter(v_, a_, reach_, ticks, h_) < 0;
  Add(swings ? ticks - 1 : ticks, a_, reach_);
  if (swings) Add(1, a_, reach_);
}

// More deceleration by a full reach each tick, until it is what the speed asks for.
void JointStop::Press() {
  const double last = std::max(0.0, std::ceil((a_ + a_max_) / reach_) + 1);
  const auto is_over = [&](double k) {
    const double next = reach_ - (a_ - k * reach_);  // the strongest deceleration of tick k + 1
    if (next >= a_max_) return true;
    const double v = SpeedAfter(v_, a_, -reach_, k, h_);
    return v <= 0 ? next >= 0 : next > 0 && v <= LandingSpeed(next, reach_, h_);
  };
  const double ticks = First(last, is_over);
  // The speed peaks where the acceleration changes its sign.
  const double rising = std::min(ticks, std::max(0.0, std::ceil(a_ / reach_) - 1));
  v_most_ = std::max(v_most_, SpeedAfter(v_, a_, -reach_, rising, h_));
  Add(ticks, a_, -reach_);
}

// Ticks at the full deceleration, as long as the speed asks for it.
void JointStop::Hold() {
  const double landing = LandingSpeed(a_max_, reach_, h_);
  if (!(v_ > 0) || v_ < landing) return;
  Add(std::floor((v_ - landing) / (h_ * a_max_)) + 1, -a_max_, 0);
}

void JointStop::Land() {
  if (!(v_ > 0)) return;
  const double ticks = LandingTicks(v_, jerk_, h_);
  const double d = (v_ / h_ + reach_ * ticks * (ticks - 1) / 2) / ticks;
  Add(ticks, -d - reach_, reach_);
}

bool CanStopWithin(const JointMotion& motion, const JointBounds& bounds, double period_s) {
  const JointStop stop(motion, bounds, period_s);
  return stop.q_least() >= bounds.q_min && stop.q_most() <= bounds.q_max &&
         stop.v_most() <= bounds.v_max;
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
