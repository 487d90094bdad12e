#include "sidestep/sim/fci/motion_check.h"

#include <algorithm>
#include <cmath>

namespace sidestep::sim::fci {
namespace {

using robot::fci::Error;
using robot::fci::ErrorSet;
using robot::fci::Joints;

constexpr std::size_t kJoints = robot::fci::kNumJoints;

// False for NaN too.
bool IsInside(double value, double limit) { return std::abs(value) < limit; }

void Note(bool is_kept, Error error, ErrorSet& errors) {
  if (!is_kept) errors.set(static_cast<std::size_t>(error));
}

}  // namespace

Reference FollowPositions(const Reference& before, const Joints& q_c) {
  Reference after;
  after.q = q_c;
  for (std::size_t i = 0; i < kJoints; ++i) {
    after.dq[i] = (q_c[i] - before.q[i]) / kTick_s;
    after.ddq[i] = (after.dq[i] - before.dq[i]) / kTick_s;
  }
  return after;
}

Reference FollowVelocities(const Reference& before, const Joints& dq_c) {
  Reference after;
  after.dq = dq_c;
  for (std::size_t i = 0; i < kJoints; ++i) {
    after.ddq[i] = (dq_c[i] - before.dq[i]) / kTick_s;
    after.q[i] = before.q[i] + dq_c[i] * kTick_s;
  }
  return after;
}

Reference Extrapolate(const Reference& before) {
  Reference after = before;
  for (std::size_t i = 0; i < kJoints; ++i) {
    after.dq[i] += before.ddq[i] * kTick_s;
    after.q[i] += after.dq[i] * kTick_s;
  }
  return after;
}

Reference Brake(const Reference& before, const JointTable& limits) {
  Reference after;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const double most = limits[i].a_max * kTick_s;
    after.dq[i] = before.dq[i] - std::clamp(before.dq[i], -most, most);
    after.ddq[i] = (after.dq[i] - before.dq[i]) / kTick_s;
    after.q[i] = before.q[i] + after.dq[i] * kTick_s;
  }
  return after;
}

bool IsAtRest(const Reference& reference) {
  const auto is_zero = [](double value) { return value == 0; };
  return std::all_of(reference.dq.begin(), reference.dq.end(), is_zero) &&
         std::all_of(reference.ddq.begin(), reference.ddq.end(), is_zero);
}

ErrorSet CheckStep(const Reference& before, const Reference& after, const JointTable& limits) {
  ErrorSet errors;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const robot::JointLimits& limit = limits[i];
    const double jerk = (after.ddq[i] - before.ddq[i]) / kTick_s;
    Note(limit.q_min < after.q[i] && after.q[i] < limit.q_max, Error::kPositionLimitsViolation,
         errors);
    Note(IsInside(after.dq[i], limit.v_max), Error::kVelocityLimitsViolation, errors);
    Note(IsInside(after.ddq[i], limit.a_max), Error::kVelocityDiscontinuity, errors);
    Note(IsInside(jerk, limit.jerk_max), Error::kAccelerationDiscontinuity, errors);
  }
  return errors;
}

ErrorSet CheckStart(const Joints& q_c, const Joints& q_d, const JointTable& limits) {
  ErrorSet errors;
  for (std::size_t i = 0; i < kJoints; ++i) {
    Note(IsInside(q_c[i] - q_d[i], limits[i].v_max * kTick_s), Error::kStartPoseInvalid, errors);
  }
  return errors;
}

ErrorSet CheckEnd(const Reference& last, const JointTable& limits) {
  const Reference still = FollowPositions(last, last.q);
  return CheckStep(last, still, limits) | CheckStep(still, FollowPositions(still, still.q), limits);
}

}  // namespace sidestep::sim::fci
