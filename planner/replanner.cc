#include "sidestep/planner/replanner.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace sidestep::planner {

Replanner::Replanner(const Planner& planner, const ReplannerOptions& options)
    : planner_(planner), options_(options) {
  const auto require = [](bool condition, const std::string& what) {
    if (!condition) throw std::invalid_argument("replanner: " + what);
  };
  require(std::isfinite(options.step_s) && options.step_s >= kLeastInterval_s,
          "step_s must be at least 1e-6");
  require(std::isfinite(options.horizon_s), "horizon_s must be finite");
  const double steps = options.horizon_s / options.step_s;
  require(std::abs(steps - std::round(steps)) < 1e-6, "horizon_s must be a multiple of step_s");
  require(options.num_states() > 3, "horizon_s must be at least 3 steps");
  require(options.flees_within_s > 0, "flees_within_s must be > 0");
  require(std::isfinite(options.direct_s) && options.direct_s >= 0, "direct_s must be >= 0");
  require(options.q_goal.size() == planner.robot().num_joints() && options.q_goal.allFinite(),
          "q_goal must be finite and as long as the robot has joints");
}

CycleTask Replanner::Prepare(EpisodeTime now, const JointState& state, HorizonOffset latency,
                             const GoalWatch& goal,
                             std::shared_ptr<const sdf::DistanceField> field) const {
  EpisodeTime t_effect = now + latency;
  if (running_) t_effect = std::max(t_effect, running_->start);
  CycleTask task = {now, t_effect, state, goal, std::move(field), running_, is_braking_};
  task.searches = searches_;
  return task;
}

CycleResult Replanner::Work(const CycleTask& task) const {
  return RunCycle(planner_, options_, task);
}

void Replanner::Forget() {
  running_.reset();
  is_braking_ = false;
  searches_ = {};
}

void Replanner::Delay(HorizonOffset by) {
  if (running_) running_->start = running_->start + by;
}

void Replanner::Accept(const CycleResult& result) {
  searches_ = result.searches;
  if (!result.plan) return;
  running_ = result.plan;
  is_braking_ = result.is_braking;
}

}  // namespace sidestep::planner
