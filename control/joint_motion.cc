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
double LandingDeceleration(double v, double jerk, double h) {
  if (v <= 0) return 0;
  const double n = std::max(1.0, std::ceil((std::sqrt(1 + 8 * v / (jerk * h * h)) - 1) / 2));
  return (v / h + jerk * h * n * (n - 1) / 2) / n;
}

}  // namespace

double BrakeAcceleration(const JointMotion& motion, const JointBounds& bounds, double period_s) {
  const double deceleration =
      std::min(bounds.a_max, LandingDeceleration(std::abs(motion.v), bounds.jerk_max, period_s));
  const double reach = bounds.jerk_max * period_s;
  return std::clamp(std::copysign(deceleration, -motion.v), motion.a - reach, motion.a + reach);
}

bool CanStopWithin(const JointMotion& motion, const JointBounds& bounds, double period_s) {
  JointMotion m = motion;
  for (;;) {
    if (m.q < bounds.q_min || m.q > bounds.q_max || std::abs(m.v) > bounds.v_max) return false;
    if (m.v == 0 && m.a == 0) return true;
    m = m.Next(BrakeAcceleration(m, bounds, period_s), period_s);
  }
}

double SafeAcceleration(const JointMotion& motion, double wanted, const JointBounds& bounds,
                        double period_s) {
  JointBounds held = bounds;
  held.q_min = std::min(bounds.q_min, motion.q);
  held.q_max = std::max(bounds.q_max, motion.q);
  held.v_max = std::max(bounds.v_max, std::abs(motion.v));

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
