#include "sidestep/bench/metrics/motion_metrics.h"

#include <algorithm>
#include <cmath>

#include "sidestep/bench/statistics.h"
#include "sidestep/core/goal.h"
#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::bench {
namespace {

constexpr double kGpStep = 0.1;  // s, the paper's

GoalWatch WatchGoal(const record::Recording& recording) {
  GoalWatch goal(recording.q_goal, recording.dwell_s, recording.tolerance_scale);
  for (const ControlSample& tick : recording.control) goal.Observe(tick.t, tick.q, tick.v);
  return goal;
}

}  // namespace

double TimeToGoal(const record::Recording& recording) {
  const GoalWatch goal = WatchGoal(recording);
  return goal.dwelt() ? goal.arrived()->seconds() : kNaN;
}

double TimeToDwell(const record::Recording& recording) {
  const GoalWatch goal = WatchGoal(recording);
  return goal.dwelt() ? goal.dwelt()->seconds() : kNaN;
}

double GoalError(const record::Recording& recording) {
  if (recording.control.empty()) return kNaN;
  return LargestDifference(recording.control.back().q, recording.q_goal, recording.tolerance_scale);
}

double GpCostOfMotion(const record::Recording& recording) {
  const auto& control = recording.control;
  if (control.empty()) return kNaN;
  std::vector<std::size_t> picks;
  double next = control.front().t.seconds();
  for (std::size_t i = 0; i < control.size(); ++i) {
    if (control[i].t.seconds() >= next - 1e-9) {
      picks.push_back(i);
      next += kGpStep;
    }
  }
  if (picks.size() < 2) return kNaN;
  const auto K = static_cast<Eigen::Index>(picks.size());
  Trajectory motion;
  motion.t_s = Eigen::VectorXd::LinSpaced(K, 0, kGpStep * static_cast<double>(K - 1));
  motion.q.resize(recording.q_goal.size(), K);
  motion.v.resize(recording.q_goal.size(), K);
  for (Eigen::Index k = 0; k < K; ++k) {
    motion.q.col(k) = control[picks[static_cast<std::size_t>(k)]].q;
    motion.v.col(k) = control[picks[static_cast<std::size_t>(k)]].v;
  }
  return planner::ComputeGpCost(motion, /*qc=*/1.0);
}

double JerkRms(const record::Recording& recording) {
  const double goal_s = TimeToGoal(recording);
  double sum = 0, count = 0;
  for (std::size_t i = 1; i < recording.control.size(); ++i) {
    const ControlSample& before = recording.control[i - 1];
    const ControlSample& tick = recording.control[i];
    if (tick.t.seconds() > goal_s) break;  // never true without a goal time (NaN)
    const double dt = (tick.t - before.t).seconds();
    sum += ((tick.a_command - before.a_command) / dt).squaredNorm();
    count += static_cast<double>(tick.a_command.size());
  }
  return count > 0 ? std::sqrt(sum / count) : kNaN;
}

double TrackingError(const record::Recording& recording) {
  double worst = recording.control.empty() ? kNaN : 0;
  for (const ControlSample& tick : recording.control) {
    worst = std::max(worst, (tick.q_command - tick.q).cwiseAbs().maxCoeff());
  }
  return worst;
}

}  // namespace sidestep::bench
