#include "sidestep/planner/replanner.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sidestep/core/cpu_time.h"
#include "sidestep/planner/clearance.h"

namespace sidestep::planner {
namespace {

constexpr const char* kBraked = "braked";
constexpr int kMinFreeStates = 3;     // fewer leave nothing to choose
constexpr double kOffPlan_rad = 0.1;  // a robot this far from its plan does not follow it
constexpr double kGoalTolerance_rad = 0.01;
constexpr double kRecordStep_s = 0.1;    // between the recorded positions of a predicted object
constexpr double kTimeEpsilon_s = 1e-9;  // support times are sums of steps, rounded

EpisodeTime EndOf(const TimedPlan& plan) {
  return plan.start + HorizonOffset(plan.trajectory.t_s(plan.trajectory.num_states() - 1));
}

// The states of a grid up to the first one at or after `t`.
int CountFixed(EpisodeTime grid_start, double step_s, EpisodeTime t) {
  const double steps = ((t - grid_start).seconds() - kTimeEpsilon_s) / step_s;
  return std::max(0, static_cast<int>(std::ceil(steps))) + 1;
}

std::vector<EpisodeTime> TimesToRecord(EpisodeTime from, EpisodeTime to) {
  std::vector<EpisodeTime> times = {from};
  for (int i = 1; from + HorizonOffset(i * kRecordStep_s - kTimeEpsilon_s) <= to; ++i) {
    times.push_back(from + HorizonOffset(i * kRecordStep_s));
  }
  return times;
}

bool IsFinite(const Trajectory& trajectory) {
  return trajectory.q.allFinite() && trajectory.v.allFinite();
}

}  // namespace

Replanner::Replanner(const Planner& planner, sdf::WorldModel& world,
                     const ReplannerOptions& options)
    : planner_(planner), world_(world), options_(options) {
  const auto require = [](bool condition, const std::string& what) {
    if (!condition) throw std::invalid_argument("replanner: " + what);
  };
  require(std::isfinite(options.step_s) && options.step_s > 0, "step_s must be > 0");
  require(std::isfinite(options.horizon_s), "horizon_s must be finite");
  const double steps = options.horizon_s / options.step_s;
  require(std::abs(steps - std::round(steps)) < 1e-6, "horizon_s must be a multiple of step_s");
  num_states_ = static_cast<int>(std::lround(steps)) + 1;
  require(num_states_ > kMinFreeStates, "horizon_s must be at least 3 steps");
  require(options.q_goal.size() == planner.robot().num_joints() && options.q_goal.allFinite(),
          "q_goal must be finite and as long as the robot has joints");
}

Replanner::Cycle Replanner::Run(EpisodeTime now, const JointState& state, HorizonOffset latency) {
  Cycle cycle;
  const double begin_s = ThreadCpuSeconds();
  const std::shared_ptr<const sdf::DistanceField> field = world_.MakeField();
  const double predicted_s = ThreadCpuSeconds();
  cycle.predict_s = predicted_s - begin_s;

  EpisodeTime t_effect = now + latency;
  if (running_) t_effect = std::max(t_effect, running_->start);
  const TimedPlan present = WithoutNewPlan(now, state);
  const auto measure = [&](const TimedPlan& plan, EpisodeTime to) {
    return MeasureClearance(planner_.robot(), *field, plan.trajectory, plan.start, t_effect, to);
  };

  CycleRecord& record = cycle.record;
  TimedPlan shown = present;
  Clearance clearance;  // of what is shown
  if (const auto request = MakeRequest(now, state, t_effect, *field)) {
    const auto plan = [&](const PlanRequest& to_plan) {
      PlanResult result = planner_.Plan(to_plan);
      record.iterations += result.iterations;
      return result;
    };
    const auto show = [&](PlanResult result, EpisodeTime start) {
      record.status = ToString(result.status);
      record.cost = result.cost.total();
      clearance = result.clearance;
      shown = {std::move(result.trajectory), start};
    };
    show(plan(*request), request->start);
    if (clearance.first_contact && running_) {
      TrajectoryPoint there = {request->q_start, request->v_start, {}};
      if (request->start < t_effect) {
        there = Sample(present.trajectory, t_effect - present.start);
        PlanResult result = plan(NewHorizon(t_effect, there.q, there.v, *field));
        if (IsSafer(result.clearance, clearance)) show(std::move(result), t_effect);
      }
      TimedPlan brake = Brake(t_effect, there);
      const Clearance braking = measure(brake, EndOf(brake));
      if (clearance.first_contact && IsSafer(braking, clearance) &&
          measure(present, EndOf(brake)).first_contact) {
        record.status = kBraked;
        clearance = braking;
        shown = std::move(brake);
      }
    }
    record.accepted =
        IsFinite(shown.trajectory) &&
        (!clearance.first_contact || IsSafer(clearance, measure(present, EndOf(shown))));
  } else {
    record.status = "kept";
    clearance = measure(present, EndOf(present));
  }
  record.predicted_clearance_m = clearance.least_m;
  if (record.accepted) {
    running_ = cycle.plan = shown;
    is_braking_ = record.status == kBraked;
  }
  cycle.optimise_s = ThreadCpuSeconds() - predicted_s;

  record.t = now;
  record.t_effect = t_effect;
  record.plan_start = shown.start;
  record.objects = world_.DescribeObjects(TimesToRecord(now, EndOf(shown)));
  record.plan = std::move(shown.trajectory);
  return cycle;
}

TimedPlan Replanner::WithoutNewPlan(EpisodeTime now, const JointState& state) const {
  if (running_ && !IsOffPlan(now, state)) return *running_;
  return {{Eigen::VectorXd::Zero(1), state.q, Eigen::VectorXd::Zero(state.q.size())}, now};
}

std::optional<PlanRequest> Replanner::MakeRequest(EpisodeTime now, const JointState& state,
                                                  EpisodeTime t_effect,
                                                  const sdf::DistanceField& field) const {
  if (!running_) {
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(state.q.size());
    PlanRequest request = NewHorizon(now, state.q, rest, field);
    request.num_fixed = CountFixed(now, options_.step_s, t_effect);
    if (num_states_ - request.num_fixed >= kMinFreeStates) return request;
    return NewHorizon(t_effect, state.q, rest, field);
  }
  if (IsOffPlan(now, state)) return NewHorizon(t_effect, state.q, state.v, field);

  const Trajectory& running = running_->trajectory;
  const int num_fixed = CountFixed(running_->start, options_.step_s, t_effect);
  if (num_states_ - num_fixed >= kMinFreeStates && !is_braking_) {
    PlanRequest request = NewHorizon(running_->start, running.q.col(0), running.v.col(0), field);
    request.initial = running;
    request.num_fixed = num_fixed;
    return request;
  }

  const bool at_rest = t_effect >= EndOf(*running_);
  const EpisodeTime judged_to =
      at_rest ? t_effect + HorizonOffset(options_.horizon_s) : EndOf(*running_);
  const bool is_free =
      !MeasureClearance(planner_.robot(), field, running, running_->start, t_effect, judged_to)
           .first_contact;
  const double goal_error_rad =
      (running.q.col(num_states_ - 1) - options_.q_goal).cwiseAbs().maxCoeff();
  if (is_free && goal_error_rad <= kGoalTolerance_rad) return std::nullopt;
  const TrajectoryPoint point = Sample(running, t_effect - running_->start);
  return NewHorizon(t_effect, point.q, point.v, field);
}

PlanRequest Replanner::NewHorizon(EpisodeTime start, const Eigen::VectorXd& q,
                                  const Eigen::VectorXd& v, const sdf::DistanceField& field) const {
  PlanRequest request;
  request.field = &field;
  request.start = start;
  request.step_s = options_.step_s;
  request.num_states = num_states_;
  request.q_start = q;
  request.v_start = v;
  request.q_goal = options_.q_goal;
  return request;
}

TimedPlan Replanner::Brake(EpisodeTime start, const TrajectoryPoint& from) const {
  int num_steps = 1;
  for (int j = 0; j < planner_.robot().num_joints(); ++j) {
    const double a_max = planner_.robot().limits()[static_cast<std::size_t>(j)].a_max;
    const double steps = std::abs(from.v(j)) / (a_max * options_.step_s);
    num_steps = std::max(num_steps, static_cast<int>(std::ceil(std::min(steps, 1e6))));
  }
  num_steps = std::min(num_steps, num_states_ - 1);
  const double brake_s = num_steps * options_.step_s;
  const Eigen::Index n = from.q.size();
  Trajectory plan{Eigen::VectorXd(num_states_), Eigen::MatrixXd(n, num_states_),
                  Eigen::MatrixXd(n, num_states_)};
  for (int k = 0; k < num_states_; ++k) {
    const double t_s = std::min(k, num_steps) * options_.step_s;
    plan.t_s(k) = k * options_.step_s;
    plan.q.col(k) = from.q + (t_s - t_s * t_s / (2 * brake_s)) * from.v;
    plan.v.col(k) = (1 - t_s / brake_s) * from.v;
  }
  return {std::move(plan), start};
}

bool Replanner::IsOffPlan(EpisodeTime now, const JointState& state) const {
  if (!running_ || now < running_->start) return false;  // what leads up to it is not known here
  const TrajectoryPoint planned = Sample(running_->trajectory, now - running_->start);
  return (state.q - planned.q).cwiseAbs().maxCoeff() > kOffPlan_rad;
}

}  // namespace sidestep::planner
