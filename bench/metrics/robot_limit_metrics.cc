#include "sidestep/bench/metrics/robot_limit_metrics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "sidestep/bench/statistics.h"

namespace sidestep::bench {
namespace {

// The first three backward differences of a signal over time, which was at rest before.
struct Differences {
  Eigen::VectorXd first, second, third;
};

// Shows `see` those at each tick but the first. `at(i)` is the signal at tick i.
template <typename At, typename See>
void ForEachDifference(const record::Recording& recording, const At& at, const See& see) {
  if (recording.control.empty()) return;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(Eigen::VectorXd(at(0)).size());
  Differences last = {rest, rest, rest};
  for (std::size_t i = 1; i < recording.control.size(); ++i) {
    const double dt = (recording.control[i].t - recording.control[i - 1].t).seconds();
    Differences now;
    now.first = (at(i) - at(i - 1)) / dt;
    now.second = (now.first - last.first) / dt;
    now.third = (now.second - last.second) / dt;
    see(now);
    last = std::move(now);
  }
}

bool IsKnown(const Eigen::VectorXd& limits) {
  return std::any_of(limits.begin(), limits.end(), [](double x) { return std::isfinite(x); });
}

double JointUse(const record::Recording& recording, Eigen::VectorXd record::MotionLimits::*limit,
                Eigen::VectorXd ControlSample::*signal, Eigen::VectorXd Differences::*difference) {
  const Eigen::VectorXd& limits = recording.robot_limits.*limit;
  if (!IsKnown(limits)) return kNaN;
  double worst = kNaN;
  ForEachDifference(
      recording, [&](std::size_t i) -> const auto& { return recording.control[i].*signal; },
      [&](const Differences& now) {
        worst = std::fmax(worst, (now.*difference).cwiseAbs().cwiseQuotient(limits).maxCoeff());
      });
  return worst;
}

double ToolAcceleration(const record::Recording& recording) {
  double worst = kNaN;
  if (recording.p_WTool.empty()) return worst;
  ForEachDifference(
      recording, [&](std::size_t i) -> const auto& { return recording.p_WTool[i]; },
      [&](const Differences& now) { worst = std::fmax(worst, now.second.norm()); });
  return worst;
}

}  // namespace

double VelocityUse(const record::Recording& recording) {
  return JointUse(recording, &record::MotionLimits::v_max, &ControlSample::q_command,
                  &Differences::first);
}

double AccelerationUse(const record::Recording& recording) {
  return JointUse(recording, &record::MotionLimits::a_max, &ControlSample::q_command,
                  &Differences::second);
}

double JerkUse(const record::Recording& recording) {
  return JointUse(recording, &record::MotionLimits::jerk_max, &ControlSample::q_command,
                  &Differences::third);
}

double ToolAccelerationUse(const record::Recording& recording) {
  if (!std::isfinite(recording.tool_a_max)) return kNaN;
  return ToolAcceleration(recording) / recording.tool_a_max;
}

double ToolReflexUse(const record::Recording& recording) {
  if (!std::isfinite(recording.tool_a_reflex)) return kNaN;
  return ToolAcceleration(recording) / recording.tool_a_reflex;
}

std::vector<TripMetric> TrippedBy(const std::map<std::string, double>& metrics) {
  std::vector<TripMetric> tripped;
  for (const TripMetric& metric : kTripMetrics) {
    if (metrics.at(metric.name) >= 1) tripped.push_back(metric);
  }
  return tripped;
}

std::string TellTrips(const std::map<std::string, double>& metrics) {
  std::string words;
  for (const TripMetric& metric : TrippedBy(metrics)) {
    words += (words.empty() ? "" : ", ") + std::string(metric.words);
  }
  if (!words.empty()) return words;
  const bool is_known = std::all_of(
      std::begin(kTripMetrics), std::end(kTripMetrics),
      [&metrics](const TripMetric& metric) { return std::isfinite(metrics.at(metric.name)); });
  return is_known ? "no" : "not by what is known";
}

}  // namespace sidestep::bench
