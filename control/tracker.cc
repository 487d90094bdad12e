#include "sidestep/control/tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace sidestep::control {
namespace {

// Fast enough that a jump of the target's acceleration by da moves the joint off by only
// 0.27 da / w^2 (0.14 mrad for 5 rad/s^2); slow enough that the jerk of answering it, 3 w da, is
// within a Panda's limits.
constexpr double kBandwidth_rad_s = 100;

// The share of the acceleration and jerk limits that the approach to a far target plans with. The
// rest is for the corrections on the way.
constexpr double kApproachShare = 0.5;

// The speed from which a joint without acceleration can stop within `distance`: the inverse of
//   distance = v sqrt(v / J)                  if v <= A^2 / J (the limit A is not reached)
//   distance = v^2 / (2 A) + v A / (2 J)      otherwise.
double StoppableSpeed(double distance, double A, double J) {
  const double ramp = A * A / J;
  if (distance <= ramp * A / J) return std::cbrt(J * distance * distance);
  return (std::sqrt(ramp * ramp + 8 * A * distance) - ramp) / 2;
}

// Feedback from the errors of position, velocity and acceleration, in nested form:
//   jerk = acceleration ((a_t + velocity ((v_t + position e) - v)) - a)        all [1/s].
// Each stage can so have its own bound. For backward Euler with tick h the characteristic
// polynomial is (z-1)^3 + A h (z-1)^2 + A V h^2 z (z-1) + A V P h^3 z^2; these gains make it
// (z - p)^3 with p = exp(-w h). For h -> 0 they are 3 w, w and w / 3.
struct Gains {
  double position, velocity, acceleration;
};

Gains PlaceTriplePole(double h) {
  const double p = std::exp(-kBandwidth_rad_s * h);
  const double third = 1 - p * p * p, second = (1 - p) * (1 - p) * (1 + 2 * p);
  const double first = (1 - p) * (1 - p) * (1 - p);
  return {first / second / h, second / third / h, third / h};
}

// A far target is approached at a speed, and a speed at an acceleration, that can be taken back in
// time; near the target it is the plain feedback.
double WantedAcceleration(const JointMotion& motion, const JointMotion& target, const Gains& gains,
                          const JointBounds& bounds, double period_s) {
  const double A = kApproachShare * bounds.a_max, J = kApproachShare * bounds.jerk_max;
  const double e = target.q - motion.q;
  const double speed = std::min(gains.position * std::abs(e), StoppableSpeed(std::abs(e), A, J));
  const double v_wanted =
      std::clamp(target.v + std::copysign(speed, e), -bounds.v_max, bounds.v_max);
  const double u = v_wanted - motion.v;
  const double correction = std::min(gains.velocity * std::abs(u), std::sqrt(2 * J * std::abs(u)));
  const double a_wanted =
      std::clamp(target.a + std::copysign(correction, u), -bounds.a_max, bounds.a_max);
  return motion.a + period_s * gains.acceleration * (a_wanted - motion.a);
}

// Where the target is one tick before `point`, in the tracker's own terms: its velocity is the
// backward difference of its positions. Exact while its acceleration is constant.
JointMotion OneTickBefore(const JointMotion& point, double h) {
  const double v = point.v - h / 2 * point.a;  // at `point`
  return {point.q - h * v, v - h * point.a, point.a};
}

JointMotion OfJoint(const JointPoint& point, int j) { return {point.q(j), point.v(j), point.a(j)}; }

}  // namespace

TrackerLimits TrackerLimits::Of(const robot::RobotModel& robot, double v_scale, double a_scale,
                                double jerk_scale) {
  const int n = robot.num_joints();
  TrackerLimits limits;
  for (Eigen::VectorXd* values :
       {&limits.q_min, &limits.q_max, &limits.v_max, &limits.a_max, &limits.jerk_max}) {
    values->resize(n);
  }
  for (int j = 0; j < n; ++j) {
    const robot::JointLimits& joint = robot.limits()[static_cast<std::size_t>(j)];
    limits.q_min(j) = joint.q_min;
    limits.q_max(j) = joint.q_max;
    limits.v_max(j) = v_scale * joint.v_max;
    limits.a_max(j) = a_scale * joint.a_max;
    limits.jerk_max(j) = jerk_scale * joint.jerk_max;
  }
  return limits;
}

JerkLimitedTracker::JerkLimitedTracker(const TrackerLimits& limits)
    : num_joints_(static_cast<int>(limits.q_min.size())) {
  for (const Eigen::VectorXd* values :
       {&limits.q_max, &limits.v_max, &limits.a_max, &limits.jerk_max}) {
    if (values->size() != num_joints_) {
      throw std::invalid_argument("JerkLimitedTracker: limits must all have one length");
    }
  }
  if (num_joints_ > kMaxJoints) {
    throw std::invalid_argument("JerkLimitedTracker: at most " + std::to_string(kMaxJoints) +
                                " joints");
  }
  for (int j = 0; j < num_joints_; ++j) {
    JointBounds& bounds = bounds_[j];
    bounds = {limits.q_min(j), limits.q_max(j), limits.v_max(j), limits.a_max(j),
              limits.jerk_max(j)};
    if (!(bounds.q_min < bounds.q_max) || !(bounds.v_max > 0) || !(bounds.a_max > 0) ||
        !(bounds.jerk_max > 0) || !std::isfinite(bounds.v_max)) {
      throw std::invalid_argument(
          "JerkLimitedTracker: q_min < q_max, other limits > 0, v_max finite");
    }
    // An unlimited joint gets the limits of its own feedback: a stop quicker than that would leave
    // an acceleration that the feedback takes back too slowly, and bounce.
    constexpr double w = kBandwidth_rad_s;
    if (std::isinf(bounds.a_max)) bounds.a_max = w * bounds.v_max;
    if (std::isinf(bounds.jerk_max)) bounds.jerk_max = 3 * w * bounds.a_max;
  }
}

template <class Acceleration>
JointPoint JerkLimitedTracker::Advance(const JointPoint& state, double period_s,
                                       const Acceleration& acceleration) const noexcept {
  JointPoint next{JointVector(num_joints_), JointVector(num_joints_), JointVector(num_joints_)};
  for (int j = 0; j < num_joints_; ++j) {
    const JointMotion motion = OfJoint(state, j);
    const JointMotion moved = motion.Next(acceleration(motion, j), period_s);
    next.q(j) = moved.q;
    next.v(j) = moved.v;
    next.a(j) = moved.a;
  }
  return next;
}

JointPoint JerkLimitedTracker::Step(const JointPoint& state, const JointPoint& target,
                                    double period_s) const noexcept {
  const Gains gains = PlaceTriplePole(period_s);
  return Advance(state, period_s, [&](const JointMotion& motion, int j) {
    const JointMotion aim = OneTickBefore(OfJoint(target, j), period_s);
    const double wanted = WantedAcceleration(motion, aim, gains, bounds(j), period_s);
    return SafeAcceleration(motion, wanted, bounds(j), period_s);
  });
}

JointPoint JerkLimitedTracker::Brake(const JointPoint& state, double period_s) const noexcept {
  return Advance(state, period_s, [&](const JointMotion& motion, int j) {
    return BrakeAcceleration(motion, bounds(j), period_s);
  });
}

}  // namespace sidestep::control
