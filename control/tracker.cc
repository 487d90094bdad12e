#include "sidestep/control/tracker.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sidestep/control/joint_motion.h"

namespace sidestep::control {
namespace {

// Fast enough that a jump of the target's acceleration by da moves the joint off by only
// 0.27 da / w^2 (0.14 mrad for 5 rad/s^2); slow enough that the jerk of answering it, 3 w da, is
// within a Panda's limits.
constexpr double kBandwidth_rad_s = 100;

// The share of the acceleration and jerk limits that the approach to a far target plans with. The
// rest is for the corrections on the way.
constexpr double kApproachShare = 0.5;

JointBounds BoundsOf(const TrackerLimits& limits, Eigen::Index j) {
  return {limits.q_min(j), limits.q_max(j), limits.v_max(j), limits.a_max(j), limits.jerk_max(j)};
}

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
JointMotion OneTickBefore(const TrajectoryPoint& point, Eigen::Index j, double h) {
  const double v = point.v(j) - h / 2 * point.a(j);  // at `point`
  return {point.q(j) - h * v, v - h * point.a(j), point.a(j)};
}

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

JerkLimitedTracker::JerkLimitedTracker(const TrackerLimits& limits, double period_s)
    : limits_(limits), period_s_(period_s) {
  if (!(period_s > 0) || !std::isfinite(period_s)) {
    throw std::invalid_argument("JerkLimitedTracker: the period must be > 0");
  }
  const Eigen::Index n = limits.q_min.size();
  for (const Eigen::VectorXd* values :
       {&limits.q_max, &limits.v_max, &limits.a_max, &limits.jerk_max}) {
    if (values->size() != n) {
      throw std::invalid_argument("JerkLimitedTracker: limits must all have one length");
    }
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    if (!(limits.q_min(j) < limits.q_max(j)) || !(limits.v_max(j) > 0) || !(limits.a_max(j) > 0) ||
        !(limits.jerk_max(j) > 0) || !std::isfinite(limits.v_max(j))) {
      throw std::invalid_argument(
          "JerkLimitedTracker: q_min < q_max, other limits > 0, v_max finite");
    }
    // An unlimited joint gets the limits of its own feedback: a stop quicker than that would leave
    // an acceleration that the feedback takes back too slowly, and bounce.
    constexpr double w = kBandwidth_rad_s;
    if (std::isinf(limits.a_max(j))) limits_.a_max(j) = w * limits.v_max(j);
    if (std::isinf(limits.jerk_max(j))) limits_.jerk_max(j) = 3 * w * limits_.a_max(j);
  }
}

void JerkLimitedTracker::Reset(const Eigen::VectorXd& q) {
  Reset(q, Eigen::VectorXd::Zero(q.size()), Eigen::VectorXd::Zero(q.size()));
}

void JerkLimitedTracker::Reset(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                               const Eigen::VectorXd& a) {
  for (const Eigen::VectorXd* values : {&q, &v, &a}) CheckShape(*values);
  q_ = q;
  v_ = v;
  a_ = a;
}

TrackerCommand JerkLimitedTracker::Step(const TrajectoryPoint& target) {
  CheckStarted();
  for (const Eigen::VectorXd* values : {&target.q, &target.v, &target.a}) CheckShape(*values);
  const Gains gains = PlaceTriplePole(period_s_);
  Eigen::VectorXd a_next(q_.size());
  for (Eigen::Index j = 0; j < q_.size(); ++j) {
    const JointBounds bounds = BoundsOf(limits_, j);
    const JointMotion motion{q_(j), v_(j), a_(j)};
    const double wanted =
        WantedAcceleration(motion, OneTickBefore(target, j, period_s_), gains, bounds, period_s_);
    a_next(j) = SafeAcceleration(motion, wanted, bounds, period_s_);
  }
  return Advance(a_next);
}

TrackerCommand JerkLimitedTracker::StepBrake() {
  CheckStarted();
  Eigen::VectorXd a_next(q_.size());
  for (Eigen::Index j = 0; j < q_.size(); ++j) {
    a_next(j) = BrakeAcceleration({q_(j), v_(j), a_(j)}, BoundsOf(limits_, j), period_s_);
  }
  return Advance(a_next);
}

TrackerCommand JerkLimitedTracker::Advance(const Eigen::VectorXd& a_next) {
  const Eigen::VectorXd jerk = (a_next - a_) / period_s_;
  for (Eigen::Index j = 0; j < q_.size(); ++j) {
    const JointMotion next = JointMotion{q_(j), v_(j), a_(j)}.Next(a_next(j), period_s_);
    q_(j) = next.q;
    v_(j) = next.v;
    a_(j) = next.a;
  }
  return {q_, v_, a_, jerk};
}

void JerkLimitedTracker::CheckStarted() const {
  if (q_.size() == 0) throw std::logic_error("JerkLimitedTracker: Reset() comes before a step");
}

void JerkLimitedTracker::CheckShape(const Eigen::VectorXd& values) const {
  if (values.size() != limits_.q_min.size() || !values.allFinite()) {
    throw std::invalid_argument("JerkLimitedTracker: must be " +
                                std::to_string(limits_.q_min.size()) + " finite numbers");
  }
}

}  // namespace sidestep::control
