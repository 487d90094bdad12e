#include "sidestep/planner/replan_cycle.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sidestep/core/cpu_time.h"
#include "sidestep/planner/braking.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/free_goal.h"
#include "sidestep/robot/tolerance_scale.h"

namespace sidestep::planner {
namespace {

constexpr const char* kBraked = "braked";
constexpr int kMinFreeStates = 3;           // fewer leave nothing to choose
constexpr double kOffPlan_rad = 0.1;        // a robot this far from its plan does not follow it
constexpr double kSlower = 1.5;             // from a horizon that is too short to the next one
constexpr double kWorthCatchingUp_s = 0.5;  // who would not arrive sooner by this much goes on
constexpr double kNotMuchNearer_m = 0.01;   // to what is there, for arriving sooner
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

// Free, within limits, at the goal.
bool IsAllThatWasAsked(PlanStatus status) {
  return status == PlanStatus::kSolved || status == PlanStatus::kNotConverged;
}

// One cycle at work: the task and what is derived from it.
class CycleWork {
 public:
  CycleWork(const Planner& planner, const ReplannerOptions& options, const CycleTask& task)
      : planner_(planner),
        options_(options),
        num_states_(options.num_states()),
        task_(task),
        now_(task.now),
        t_effect_(task.t_effect),
        field_(*task.field),
        running_(task.running),
        scale_(robot::ToleranceScale(planner.robot())),
        is_off_plan_(IsOffPlan()),
        expected_(Expect()) {}

  CycleResult Run() const;

 private:
  bool IsMoving() const;
  bool IsOffPlan() const;
  // How the robot will be at t_effect: as its plan says, if it follows one.
  TrajectoryPoint Expect() const;
  // The request of this cycle; none if the running plan is to be kept.
  std::optional<PlanRequest> MakeRequest() const;
  // Until when the robot is asked to stay at its goal, where its running plan keeps it as long;
  // t_effect if it is not asked, or is not there.
  EpisodeTime StayUntil() const;
  bool RestsAtGoal(const TimedPlan& plan, EpisodeTime from, EpisodeTime to) const;
  // A whole horizon from `start`.
  PlanRequest NewHorizon(EpisodeTime start, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& v) const;
  // Of a horizon from t_effect in which the rest of the running plan's time, taken `slower` times
  // as slowly, is enough; and of the next one to try, if it is not.
  int StatesSlowedDown(double slower) const;
  int Slower(int num_states) const;
  // Of a horizon from t_effect that is to what is left of the way, as the whole horizon is to all.
  int StatesAtPace() const;
  EpisodeTime EndOfNew(int num_states) const;
  // A whole horizon from `start`: comes to rest, and stays.
  TimedPlan Brake() const;

  const Planner& planner_;
  const ReplannerOptions& options_;
  const int num_states_;
  const CycleTask& task_;
  const EpisodeTime now_, t_effect_;
  const sdf::DistanceField& field_;
  const std::optional<TimedPlan>& running_;
  const Eigen::VectorXd scale_;  // of tolerances
  const bool is_off_plan_;
  const TrajectoryPoint expected_;  // at t_effect
};

CycleResult CycleWork::Run() const {
  CycleResult cycle;
  const double begin_s = ThreadCpuSeconds();
  const TimedPlan present = running_ ? *running_ : Brake();
  const auto measure = [&](const TimedPlan& plan, EpisodeTime to) {
    return planner_.clearance_meter().Measure(field_, plan.trajectory, plan.start, t_effect_, to);
  };

  CycleRecord& record = cycle.record;
  TimedPlan shown = present;
  Clearance clearance;  // of what is shown
  int spent = 0;
  // One search: where the cycle before left it, with so much of the budget.
  const auto plan = [&](PlanRequest to_plan, SearchProgress CycleSearches::*search,
                        const PlanBudget& budget) {
    to_plan.budget = budget;
    to_plan.progress = task_.searches.*search;
    PlanResult result = planner_.Plan(to_plan);
    spent += result.spent;
    record.iterations += result.iterations;
    record.cut_short = record.cut_short || result.progress.cut_short;
    cycle.searches.*search = result.progress;
    return result;
  };
  // Not worth beginning once all is spent: then the next cycle keeps something for it.
  const auto plan_anew = [&](int num_states) -> std::optional<PlanResult> {
    if (!task_.budget.IsSpent(spent)) {
      PlanRequest anew = NewHorizon(t_effect_, expected_.q, expected_.v);
      anew.num_states = num_states;
      return plan(std::move(anew), &CycleSearches::anew, task_.budget.WhatIsLeft(spent));
    }
    if (task_.searches.anew.cut_short) cycle.searches.anew = task_.searches.anew;
    cycle.searches.anew.cut_short = record.cut_short = true;
    return std::nullopt;
  };
  // Whether a robot at its goal may stay as long as it is asked to, and find a way out then.
  const auto may_stay = [&] {
    if (!running_ || is_off_plan_) return false;
    const EpisodeTime until = StayUntil();
    if (until <= t_effect_ || measure(present, until).first_contact) return false;
    const TrajectoryPoint there = Sample(present.trajectory, until - present.start);
    const PlanResult way_out = plan(NewHorizon(until, there.q, there.v), &CycleSearches::way_out,
                                    task_.budget.HalfOfWhatIsLeft(spent));
    return way_out.trajectory && !way_out.clearance.first_contact;
  };
  const auto request = MakeRequest();
  if (request && !may_stay()) {
    bool is_new = false;
    const auto show = [&](PlanResult result, EpisodeTime start) {
      record.status = ToString(result.status);
      record.reason = result.reason;
      record.cost = result.cost.total();
      is_new = result.trajectory.has_value();
      if (is_new) shown = {*std::move(result.trajectory), start};
      clearance = is_new ? result.clearance : measure(present, EndOf(present));
    };
    const bool goes_on = request->initial.has_value();
    PlanResult result =
        plan(*request, goes_on ? &CycleSearches::going_on : &CycleSearches::anew,
             goes_on && task_.searches.anew.cut_short ? task_.budget.HalfOfWhatIsLeft(spent)
                                                      : task_.budget.WhatIsLeft(spent));
    // What is not finished may keep its limits once it is.
    const bool is_too_fast = result.status == PlanStatus::kOverLimits &&
                             !result.progress.cut_short && result.limit_share > kMuchTooFast;
    const bool is_calm = IsAllThatWasAsked(result.status);
    const bool wants_time = is_too_fast || result.status == PlanStatus::kShortOfGoal;
    const double limit_share = result.limit_share;
    show(std::move(result), request->start);
    if (wants_time && running_ && request->start < t_effect_) {
      // Not all at once: with much time for what is left of a motion, an arm swings past the goal.
      int num_states = is_too_fast ? StatesSlowedDown(limit_share) : num_states_;
      std::optional<PlanResult> anew = plan_anew(num_states);
      while (anew && !IsAllThatWasAsked(anew->status) && num_states < num_states_) {
        const bool is_still_too_fast = anew->status == PlanStatus::kOverLimits;
        num_states = is_still_too_fast ? Slower(num_states) : num_states_;
        anew = plan_anew(num_states);
      }
      if (anew && IsAllThatWasAsked(anew->status)) show(*std::move(anew), t_effect_);
    }
    if (is_calm && goes_on && !task_.budget.IsSpent(spent)) {
      const int at_pace = StatesAtPace();
      if (EndOf(present) >= EndOfNew(at_pace) + HorizonOffset(kWorthCatchingUp_s)) {
        std::optional<PlanResult> sooner = plan_anew(at_pace);
        if (sooner && IsAllThatWasAsked(sooner->status) &&
            sooner->clearance.least_m > clearance.least_m - kNotMuchNearer_m) {
          show(*std::move(sooner), t_effect_);
        }
      }
    }
    const bool has_to_flee =
        clearance.first_contact &&
        (*clearance.first_contact - t_effect_).seconds() <= options_.flees_within_s;
    if (has_to_flee && running_) {
      if (request->start < t_effect_) {
        std::optional<PlanResult> anew = plan_anew(num_states_);
        if (anew && anew->trajectory && IsSafer(anew->clearance, clearance)) {
          show(*std::move(anew), t_effect_);
        }
      }
      TimedPlan brake = Brake();
      const Clearance braking = measure(brake, EndOf(brake));
      if (clearance.first_contact && IsSafer(braking, clearance) &&
          measure(present, EndOf(brake)).first_contact) {
        record.status = kBraked;
        is_new = true;
        clearance = braking;
        shown = std::move(brake);
      }
    }
    record.accepted =
        is_new && (!clearance.first_contact || IsSafer(clearance, measure(present, EndOf(shown))));
  } else {
    record.status = "kept";
    clearance = measure(present, EndOf(present));
  }
  record.predicted_clearance_m = clearance.least_m;
  record.samples_outside_grid = clearance.samples_outside_grid;
  if (record.accepted) {
    cycle.plan = shown;
    cycle.is_braking = record.status == kBraked;
  }
  cycle.optimise_s = ThreadCpuSeconds() - begin_s;

  record.t = now_;
  record.t_effect = t_effect_;
  record.plan_start = shown.start;
  record.plan = std::move(shown.trajectory);
  return cycle;
}

TrajectoryPoint CycleWork::Expect() const {
  const std::vector<robot::JointLimits>& limits = planner_.robot().limits();
  if (!running_)
    return IsMoving() ? Stop(limits, task_.state, t_effect_ - now_) : RestAt(task_.state.q);
  if (is_off_plan_) return MoveOn(limits, task_.state, t_effect_ - now_);
  return Sample(running_->trajectory, t_effect_ - running_->start);
}

std::optional<PlanRequest> CycleWork::MakeRequest() const {
  const PlanRequest anew = NewHorizon(t_effect_, expected_.q, expected_.v);
  if (!running_) {
    if (IsMoving()) return anew;
    PlanRequest request = NewHorizon(now_, expected_.q, expected_.v);
    request.num_fixed = CountFixed(now_, options_.step_s, t_effect_);
    return num_states_ - request.num_fixed >= kMinFreeStates ? request : anew;
  }
  if (is_off_plan_) return anew;

  const Trajectory& running = running_->trajectory;
  const int num_fixed = CountFixed(running_->start, options_.step_s, t_effect_);
  if (running.num_states() - num_fixed >= kMinFreeStates && !task_.is_braking) {
    PlanRequest request = NewHorizon(running_->start, running.q.col(0), running.v.col(0));
    request.num_states = running.num_states();
    request.initial = running;
    request.num_fixed = num_fixed;
    return request;
  }

  const bool at_rest = t_effect_ >= EndOf(*running_);
  const EpisodeTime judged_to =
      at_rest ? t_effect_ + HorizonOffset(options_.horizon_s) : EndOf(*running_);
  const bool is_free = !planner_.clearance_meter()
                            .Measure(field_, running, running_->start, t_effect_, judged_to)
                            .first_contact;
  if (is_free && EndsAtGoal(running, options_.q_goal, scale_)) return std::nullopt;
  // Where it waits for a goal that is blocked, it rests.
  const EpisodeTime horizon_end = t_effect_ + HorizonOffset(options_.horizon_s);
  if (is_free && !task_.is_braking &&
      IsBlocked(planner_.robot(), field_, options_.q_goal, horizon_end)) {
    return std::nullopt;
  }
  return anew;
}

EpisodeTime CycleWork::StayUntil() const {
  if (task_.goal.dwelt()) return t_effect_;
  const EpisodeTime end = EndOf(*running_);
  // Not seen at the goal, it lags its plan; or is kept away, and then nobody waits for its
  // arrival.
  const bool lags = t_effect_ >= end && now_ <= end + HorizonOffset(kArrivesLate_s);
  if (!task_.goal.arrived() && !lags) return t_effect_;
  const EpisodeTime until =
      task_.goal.arrived().value_or(std::max(now_, end)) + HorizonOffset(task_.goal.dwell_s());
  return RestsAtGoal(*running_, t_effect_, until) ? until : t_effect_;
}

bool CycleWork::RestsAtGoal(const TimedPlan& plan, EpisodeTime from, EpisodeTime to) const {
  const Trajectory& motion = plan.trajectory;
  std::vector<HorizonOffset> offsets = {from - plan.start, to - plan.start};
  for (const double t_s : motion.t_s) {
    if (t_s > offsets[0].seconds() && t_s < offsets[1].seconds()) offsets.emplace_back(t_s);
  }
  return std::all_of(offsets.begin(), offsets.end(), [&](HorizonOffset offset) {
    const TrajectoryPoint point = Sample(motion, offset);
    return LargestDifference(point.q, options_.q_goal, scale_) <= kPlannedGoalTolerance_rad &&
           LargestDifference(point.v, Eigen::VectorXd::Zero(point.v.size()), scale_) <=
               kGoalSpeed_rad_s;
  });
}

PlanRequest CycleWork::NewHorizon(EpisodeTime start, const Eigen::VectorXd& q,
                                  const Eigen::VectorXd& v) const {
  PlanRequest request;
  request.field = &field_;
  request.start = start;
  request.step_s = options_.step_s;
  request.num_states = num_states_;
  request.q_start = q;
  request.v_start = v;
  request.q_goal = options_.q_goal;
  return request;
}

int CycleWork::StatesSlowedDown(double slower) const {
  const double left_s = std::max(0.0, (EndOf(*running_) - t_effect_).seconds());
  const auto num_steps = static_cast<int>(std::ceil(left_s * slower / options_.step_s));
  return std::clamp(num_steps + 1, std::min(kMinFreeStates + 1, num_states_), num_states_);
}

int CycleWork::Slower(int num_states) const {
  return std::min(num_states_, static_cast<int>(std::ceil(kSlower * num_states)));
}

int CycleWork::StatesAtPace() const {
  if (options_.direct_s <= 0) return num_states_;  // no limit, no pace
  double stop_s = 0;
  for (int j = 0; j < planner_.robot().num_joints(); ++j) {
    const double a_max = planner_.robot().limits()[static_cast<std::size_t>(j)].a_max;
    stop_s = std::max(stop_s, std::abs(expected_.v(j)) / a_max);
  }
  const double left_s = planner_.DirectTime_s(expected_.q, options_.q_goal) + stop_s;
  const double num_steps = std::ceil(left_s / options_.direct_s * (num_states_ - 1));
  return static_cast<int>(std::clamp<double>(num_steps, kMinFreeStates, num_states_ - 1)) + 1;
}

EpisodeTime CycleWork::EndOfNew(int num_states) const {
  return t_effect_ + HorizonOffset((num_states - 1) * options_.step_s);
}

TimedPlan CycleWork::Brake() const {
  return {MakeBraking(planner_.robot().limits(), expected_, options_.step_s, num_states_),
          t_effect_};
}

bool CycleWork::IsMoving() const {
  const Eigen::VectorXd& v = task_.state.v;
  return LargestDifference(v, Eigen::VectorXd::Zero(v.size()), scale_) > kStill_rad_s;
}

bool CycleWork::IsOffPlan() const {
  if (!running_ || now_ < running_->start) return false;  // what leads up to it is not known here
  const TrajectoryPoint planned = Sample(running_->trajectory, now_ - running_->start);
  return LargestDifference(task_.state.q, planned.q, scale_) > kOffPlan_rad;
}

}  // namespace

int ReplannerOptions::num_states() const {
  return static_cast<int>(std::lround(horizon_s / step_s)) + 1;
}

CycleResult RunCycle(const Planner& planner, const ReplannerOptions& options,
                     const CycleTask& task) {
  return CycleWork(planner, options, task).Run();
}

std::vector<EpisodeTime> TimesToDescribe(const CycleRecord& record) {
  const EpisodeTime end = EndOf({record.plan, record.plan_start});
  std::vector<EpisodeTime> times = {record.t};
  for (int i = 1; record.t + HorizonOffset(i * kRecordStep_s - kTimeEpsilon_s) <= end; ++i) {
    times.push_back(record.t + HorizonOffset(i * kRecordStep_s));
  }
  return times;
}

}  // namespace sidestep::planner
