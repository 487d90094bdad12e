#include "sidestep/bench/metrics/limit_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sidestep/bench/statistics.h"
#include "sidestep/planner/limit_use.h"

namespace sidestep::bench {
namespace {

constexpr double kTimeEpsilon_s = 1e-9;  // support times are sums of steps, rounded

bool HasLimit(const Eigen::VectorXd& limits) {
  return std::any_of(limits.begin(), limits.end(), [](double x) { return std::isfinite(x); });
}

std::vector<robot::JointLimits> JointLimitsOf(const record::MotionLimits& asked) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<robot::JointLimits> joints;
  for (Eigen::Index j = 0; j < asked.v_max.size(); ++j) {
    joints.push_back({-kNone, kNone, asked.v_max(j), asked.a_max(j), asked.jerk_max(j), kNone,
                      asked.torque_rate_max(j)});
  }
  return joints;
}

double PlannedUse(const record::Recording& recording, Eigen::VectorXd record::MotionLimits::*limit,
                  double planner::LimitUse::*use) {
  if (!HasLimit(recording.limits.*limit)) return kNaN;
  const std::vector<robot::JointLimits> joints = JointLimitsOf(recording.limits);
  double worst = kNaN;
  for (const CycleRecord& cycle : recording.cycles) {
    if (!cycle.accepted || cycle.plan.num_states() == 0) continue;
    const double effect_s = (cycle.t_effect - cycle.plan_start).seconds() + kTimeEpsilon_s;
    const auto after = std::upper_bound(cycle.plan.t_s.begin(), cycle.plan.t_s.end(), effect_s);
    const auto first = std::max<std::ptrdiff_t>(after - cycle.plan.t_s.begin(), 1) - 1;
    worst = std::fmax(worst,
                      planner::MeasureLimitUse(joints, cycle.plan, static_cast<int>(first)).*use);
  }
  return worst;
}

double LargestShare(const Eigen::VectorXd& values, const Eigen::VectorXd& limits) {
  return values.cwiseAbs().cwiseQuotient(limits).maxCoeff();
}

double CommandedUse(const record::Recording& recording, const Eigen::VectorXd& limits,
                    Eigen::VectorXd ControlSample::*value) {
  if (!HasLimit(limits)) return kNaN;
  double worst = kNaN;
  for (const ControlSample& tick : recording.control) {
    worst = std::fmax(worst, LargestShare(tick.*value, limits));
  }
  return worst;
}

// Of the rate of a value.
double CommandedRateUse(const record::Recording& recording, const Eigen::VectorXd& limits,
                        Eigen::VectorXd ControlSample::*value) {
  if (!HasLimit(limits)) return kNaN;
  double worst = kNaN;
  for (std::size_t i = 1; i < recording.control.size(); ++i) {
    const ControlSample& before = recording.control[i - 1];
    const ControlSample& tick = recording.control[i];
    const Eigen::VectorXd rate = (tick.*value - before.*value) / (tick.t - before.t).seconds();
    worst = std::fmax(worst, LargestShare(rate, limits));
  }
  return worst;
}

}  // namespace

double PlannedVelocityUse(const record::Recording& recording) {
  return PlannedUse(recording, &record::MotionLimits::v_max, &planner::LimitUse::velocity);
}

double PlannedAccelerationUse(const record::Recording& recording) {
  return PlannedUse(recording, &record::MotionLimits::a_max, &planner::LimitUse::acceleration);
}

double PlannedJerkUse(const record::Recording& recording) {
  return PlannedUse(recording, &record::MotionLimits::jerk_max, &planner::LimitUse::jerk);
}

double CommandedVelocityUse(const record::Recording& recording) {
  return CommandedUse(recording, recording.limits.v_max, &ControlSample::v_command);
}

double CommandedAccelerationUse(const record::Recording& recording) {
  return CommandedUse(recording, recording.limits.a_max, &ControlSample::a_command);
}

double CommandedJerkUse(const record::Recording& recording) {
  return CommandedRateUse(recording, recording.limits.jerk_max, &ControlSample::a_command);
}

double CommandedTorqueRateUse(const record::Recording& recording) {
  return CommandedRateUse(recording, recording.limits.torque_rate_max, &ControlSample::torque);
}

}  // namespace sidestep::bench
