#include "sidestep/planner/replanner.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sidestep/core/cpu_time.h"
#include "sidestep/planner/braking.h"
#include "sidestep/planner/clearance.h"

namespace sidestep::planner {
namespace {

constexpr const char* kBraked = "braked";
constexpr int kMinFreeStates = 3;        // fewer leave nothing to choose
constexpr double kOffPlan_rad = 0.1;     // a robot this far from its plan does not follow it
constexpr double kStill_rad_s = 0.01;    // what is measured of a robot at rest is noise below this
constexpr double kArrivesLate_s = 0.5;   // an arm lags its plan by less, or does not arrive by it
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

// Where a robot is after `ahead` if each joint stops as fast as it may.
TrajectoryPoint Stop(const std::vector<robot::JointLimits>& limits, const JointState& state,
                     HorizonOffset ahead) {
  TrajectoryPoint point = {state.q, state.v, Eigen::VectorXd::Zero(state.q.size())};
  for (Eigen::Index j = 0; j < state.q.size(); ++j) {
    const double stop_s = std::abs(state.v(j)) / limits[static_cast<std::size_t>(j)].a_max;
    const double share = ahead.seconds() < stop_s ? ahead.seconds() / stop_s : 1;
    point.q(j) += state.v(j) * stop_s * (share - share * share / 2);
    point.v(j) *= 1 - share;
  }
  return point;
}

// Where a robot is after `ahead` if it moves on as it does, as far as its limits let it.
TrajectoryPoint MoveOn(const std::vector<robot::JointLimits>& limits, const JointState& state,
                       HorizonOffset ahead) {
  TrajectoryPoint point = {state.q, state.v, Eigen::VectorXd::Zero(state.q.size())};
  for (Eigen::Index j = 0; j < state.q.size(); ++j) {
    const robot::JointLimits& joint = limits[static_cast<std::size_t>(j)];
    point.v(j) = std::clamp(state.v(j), -joint.v_max, joint.v_max);
    const double q = state.q(j) + ahead.seconds() * point.v(j);
    // One that is beyond a limit already may be there.
    point.q(j) =
        std::clamp(q, std::min(joint.q_min, state.q(j)), std::max(joint.q_max, state.q(j)));
    if (point.q(j) != q) point.v(j) = 0;
  }
  return point;
}

TrajectoryPoint RestAt(const Eigen::VectorXd& q) {
  return {q, Eigen::VectorXd::Zero(q.size()), Eigen::VectorXd::Zero(q.size())};
}

bool IsMoving(const JointState& state) { return state.v.cwiseAbs().maxCoeff() > kStill_rad_s; }

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
  require(std::isfinite(options.step_s) && options.step_s >= kLeastInterval_s,
          "step_s must be at least 1e-6");
  require(std::isfinite(options.horizon_s), "horizon_s must be finite");
  const double steps = options.horizon_s / options.step_s;
  require(std::abs(steps - std::round(steps)) < 1e-6, "horizon_s must be a multiple of step_s");
  num_states_ = static_cast<int>(std::lround(steps)) + 1;
  require(num_states_ > kMinFreeStates, "horizon_s must be at least 3 steps");
  require(options.q_goal.size() == planner.robot().num_joints() && options.q_goal.allFinite(),
          "q_goal must be finite and as long as the robot has joints");
}

Replanner::Cycle Replanner::Run(EpisodeTime now, const JointState& state, HorizonOffset latency,
                                const GoalWatch& goal) {
  Cycle cycle;
  const double begin_s = ThreadCpuSeconds();
  const std::shared_ptr<const sdf::DistanceField> field = world_.MakeField();
  const double predicted_s = ThreadCpuSeconds();
  cycle.predict_s = predicted_s - begin_s;

  EpisodeTime t_effect = now + latency;
  if (running_) t_effect = std::max(t_effect, running_->start);
  const TrajectoryPoint expected = Expect(now, state, t_effect);
  const TimedPlan present = running_ ? *running_ : Brake(t_effect, expected);
  const auto measure = [&](const TimedPlan& plan, EpisodeTime to) {
    return MeasureClearance(planner_.robot(), *field, plan.trajectory, plan.start, t_effect, to);
  };

  CycleRecord& record = cycle.record;
  TimedPlan shown = present;
  Clearance clearance;  // of what is shown
  const auto plan = [&](const PlanRequest& to_plan) {
    PlanResult result = planner_.Plan(to_plan);
    record.iterations += result.iterations;
    return result;
  };
  // Whether a robot at its goal may stay as long as it is asked to, and find a way out then.
  const auto may_stay = [&] {
    if (!running_ || IsOffPlan(now, state)) return false;
    const EpisodeTime until = StayUntil(now, t_effect, goal);
    if (until <= t_effect || measure(present, until).first_contact) return false;
    const TrajectoryPoint there = Sample(present.trajectory, until - present.start);
    return !plan(NewHorizon(until, there.q, there.v, *field)).clearance.first_contact;
  };
  const auto request = MakeRequest(now, state, t_effect, expected, *field);
  if (request && !may_stay()) {
    const auto show = [&](PlanResult result, EpisodeTime start) {
      record.status = ToString(result.status);
      record.cost = result.cost.total();
      clearance = result.clearance;
      shown = {std::move(result.trajectory), start};
    };
    show(plan(*request), request->start);
    if (clearance.first_contact && running_) {
      if (request->start < t_effect) {
        PlanResult result = plan(NewHorizon(t_effect, expected.q, expected.v, *field));
        if (IsSafer(result.clearance, clearance)) show(std::move(result), t_effect);
      }
      TimedPlan brake = Brake(t_effect, expected);
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
  record.samples_outside_grid = clearance.samples_outside_grid;
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

TrajectoryPoint Replanner::Expect(EpisodeTime now, const JointState& state,
                                  EpisodeTime t_effect) const {
  const std::vector<robot::JointLimits>& limits = planner_.robot().limits();
  if (!running_) return IsMoving(state) ? Stop(limits, state, t_effect - now) : RestAt(state.q);
  if (IsOffPlan(now, state)) return MoveOn(limits, state, t_effect - now);
  return Sample(running_->trajectory, t_effect - running_->start);
}

std::optional<PlanRequest> Replanner::MakeRequest(EpisodeTime now, const JointState& state,
                                                  EpisodeTime t_effect,
                                                  const TrajectoryPoint& expected,
                                                  const sdf::DistanceField& field) const {
  const PlanRequest anew = NewHorizon(t_effect, expected.q, expected.v, field);
  if (!running_) {
    if (IsMoving(state)) return anew;
    PlanRequest request = NewHorizon(now, expected.q, expected.v, field);
    request.num_fixed = CountFixed(now, options_.step_s, t_effect);
    return num_states_ - request.num_fixed >= kMinFreeStates ? request : anew;
  }
  if (IsOffPlan(now, state)) return anew;

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
  const double goal_error_rad = (running.q.rightCols<1>() - options_.q_goal).cwiseAbs().maxCoeff();
  if (is_free && goal_error_rad <= kPlannedGoalTolerance_rad) return std::nullopt;
  return anew;
}

EpisodeTime Replanner::StayUntil(EpisodeTime now, EpisodeTime t_effect,
                                 const GoalWatch& goal) const {
  if (goal.dwelt()) return t_effect;
  const EpisodeTime end = EndOf(*running_);
  // Not seen at the goal, it lags its plan; or is kept away, and then nobody waits for its arrival.
  const bool lags = t_effect >= end && now <= end + HorizonOffset(kArrivesLate_s);
  if (!goal.arrived() && !lags) return t_effect;
  const EpisodeTime until =
      goal.arrived().value_or(std::max(now, end)) + HorizonOffset(goal.dwell_s());
  return RestsAtGoal(*running_, t_effect, until) ? until : t_effect;
}

bool Replanner::RestsAtGoal(const TimedPlan& plan, EpisodeTime from, EpisodeTime to) const {
  const Trajectory& motion = plan.trajectory;
  std::vector<HorizonOffset> offsets = {from - plan.start, to - plan.start};
  for (const double t_s : motion.t_s) {
    if (t_s > offsets[0].seconds() && t_s < offsets[1].seconds()) offsets.emplace_back(t_s);
  }
  return std::all_of(offsets.begin(), offsets.end(), [&](HorizonOffset offset) {
    const TrajectoryPoint point = Sample(motion, offset);
    return (point.q - options_.q_goal).cwiseAbs().maxCoeff() <= kPlannedGoalTolerance_rad &&
           point.v.cwiseAbs().maxCoeff() <= kGoalSpeed_rad_s;
  });
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
  return {MakeBraking(planner_.robot().limits(), from, options_.step_s, num_states_), start};
}

bool Replanner::IsOffPlan(EpisodeTime now, const JointState& state) const {
  if (!running_ || now < running_->start) return false;  // what leads up to it is not known here
  const TrajectoryPoint planned = Sample(running_->trajectory, now - running_->start);
  return (state.q - planned.q).cwiseAbs().maxCoeff() > kOffPlan_rad;
}

}  // namespace sidestep::planner
