#include "sidestep/planner/seeded_planner.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sidestep/core/goal.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/free_goal.h"
#include "sidestep/planner/seeds.h"
#include "sidestep/robot/tolerance_scale.h"

namespace sidestep::planner {
namespace {

// Of each stage of a further seed. Those that lead anywhere do so soon; what is left to be had, the
// next cycle gets from a warm start.
constexpr int kTrialIterations = 12;

// Weights of limits, of the usual.
constexpr double kStiffer[] = {10, 100};

constexpr double kMuchClearer_m = 0.01;

constexpr double kColdTolerance = 1e-3;  // of the first stage, whose result is only a start

PlanAnswer Near(PlanAnswer answer) {
  answer.why_short = "the goal is blocked when the horizon ends";
  return answer;
}

}  // namespace

// One request at work: what has been tried counts against its budget.
class SeededPlanner::Search {
 public:
  Search(const SeededPlanner& planner, const PlanRequest& request, PlanJudge& judge)
      : planner_(planner),
        request_(request),
        judge_(judge),
        optimizer_(planner.MakeOptimizer(request)) {}

  int iterations() const { return iterations_; }
  int spent() const { return iterations_ + num_solves_; }
  bool IsSpent() const { return request_.budget.IsSpent(spent()); }
  /// Whether a solve ended for want of budget alone.
  bool was_cut_short() const { return was_cut_short_; }

  /// What the last search, which was cut short, had found so far, improved a little; none if there
  /// was none, or the plan that runs has become free: then it is improved like any other.
  std::optional<Candidate> TakeUp() {
    const SearchProgress& progress = request_.progress;
    if (!progress.cut_short || progress.next_seed == 0 || !progress.best) return std::nullopt;
    if (request_.initial && judge_.Judge(MakeWarmStart(request_)).is_free()) return std::nullopt;
    optimizer_->Restart(MakeContinuation(request_, *progress.best));
    return SolveWithStiffening(MostTrialIterations());
  }

  /// With `to_beat` it is a trial, for one of many seeds: few iterations, and it gives up after the
  /// first stage if that touches something and is not safer.
  Candidate Solve(const Trajectory& guess, Stages stages, const Clearance* to_beat = nullptr) {
    optimizer_->Restart(guess);
    const int max_iterations = to_beat ? MostTrialIterations() : planner_.gp().max_iterations;
    if (stages == Stages::kWithLimits) return SolveWithLimits(1, max_iterations);
    Improve(max_iterations, kColdTolerance);
    if (to_beat) {
      PlanAnswer answer;
      answer.trajectory = optimizer_->GetTrajectory();
      Candidate first = Judged(std::move(answer));
      if (!first.verdict.is_free() && !IsSafer(first.verdict.clearance, *to_beat)) return first;
    }
    return SolveWithStiffening(max_iterations);
  }

  /// The result of a trial, brought to its end.
  Candidate Finish(const Candidate& trial) {
    optimizer_->Restart(*trial.answer.trajectory);
    return SolveWithStiffening(planner_.gp().max_iterations);
  }

  Candidate LeaveAsItIs(const Trajectory& motion) {
    optimizer_->Restart(motion);
    return SolveWithLimits(1, 0);
  }

 private:
  int MostTrialIterations() const {
    return std::min(kTrialIterations, planner_.gp().max_iterations);
  }

  // Soft limits give way where much is at stake: those of a free plan that exceeds them get
  // stiffer. One that is not finished may yet come to keep them by itself.
  Candidate SolveWithStiffening(int max_iterations) {
    Candidate best = SolveWithLimits(1, max_iterations);
    for (const double stiffness : kStiffer) {
      const bool is_finished = best.answer.converged && best.verdict.is_free();
      if (!is_finished || best.verdict.keeps_limits || IsSpent()) break;
      Candidate stiffer = SolveWithLimits(stiffness, MostTrialIterations());
      if (!planner_.EndsAtGoalOf(request_, *stiffer.answer.trajectory))
        break;  // there is too little time
      if (planner_.IsBetter(stiffer.verdict, best.verdict)) best = std::move(stiffer);
    }
    return best;
  }

  Candidate SolveWithLimits(double stiffness, int max_iterations) {
    optimizer_->AddLimits(stiffness);
    PlanAnswer answer;
    answer.converged = Improve(max_iterations, planner_.gp().function_tolerance);
    answer.trajectory = optimizer_->GetTrajectory();
    answer.cost = optimizer_->ComputeCost();
    return Judged(std::move(answer));
  }

  bool Improve(int max_iterations, double function_tolerance) {
    const int left = std::max(0, request_.budget.iterations - spent());
    const SolveOutcome outcome =
        optimizer_->Solve(std::min(max_iterations, left), function_tolerance);
    iterations_ += outcome.iterations;
    ++num_solves_;
    if (!outcome.converged && (left < max_iterations || request_.budget.IsTimeUp())) {
      was_cut_short_ = true;
    }
    return outcome.converged;
  }

  Candidate Judged(PlanAnswer answer) {
    const Verdict verdict = judge_.Judge(*answer.trajectory);
    return {std::move(answer), verdict};
  }

  const SeededPlanner& planner_;
  const PlanRequest& request_;
  PlanJudge& judge_;
  std::unique_ptr<TrajectoryOptimizer> optimizer_;
  int iterations_ = 0, num_solves_ = 0;
  bool was_cut_short_ = false;
};

bool SeededPlanner::EndsAtGoalOf(const PlanRequest& request, const Trajectory& trajectory) const {
  return EndsAtGoal(trajectory, request.q_goal, robot::ToleranceScale(robot()));
}

bool SeededPlanner::LeadsToGoal(const PlanRequest& request) const {
  return request.initial && EndsAtGoalOf(request, *request.initial);
}

bool SeededPlanner::IsBetter(const Verdict& a, const Verdict& b) const {
  const auto rank = [this](const Verdict& verdict) {
    if (!verdict.is_free()) return 0;
    if (verdict.keeps_limits) return 3;
    return KeepsWholeLimits(verdict.limit_use, settings()) ? 2 : 1;
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  return IsSafer(a.clearance, b.clearance);
}

std::optional<PlanRequest> SeededPlanner::WithFreeGoal(const PlanRequest& request) const {
  const EpisodeTime end = request.start + HorizonOffset((request.num_states - 1) * request.step_s);
  if (!IsBlocked(robot(), *request.field, request.q_goal, end)) return std::nullopt;
  const std::optional<Eigen::VectorXd> free_goal =
      FindFreeGoal(robot(), *request.field, settings(), request.q_goal, end);
  if (!free_goal) return std::nullopt;
  PlanRequest nearby = request;
  nearby.q_goal = *free_goal;
  return nearby;
}

// A goal is looked at before all else, but for one that the plan that runs leads to: most such
// plans stay free, and then it is.
PlanAnswer SeededPlanner::DoPlan(const PlanRequest& request, PlanJudge& judge) const {
  if (!LeadsToGoal(request)) {
    if (const std::optional<PlanRequest> nearby = WithFreeGoal(request)) {
      return Near(TryAll(*nearby, judge));
    }
  }
  return TryAll(request, judge);
}

PlanAnswer SeededPlanner::TryAll(const PlanRequest& request, PlanJudge& judge) const {
  Search search(*this, request, judge);
  Seeds seeds(request, gp_.num_detours, robot::ToleranceScale(robot()));
  std::optional<Candidate> taken_up = search.TakeUp();
  const bool is_taken_up = taken_up.has_value();
  const int first = is_taken_up ? request.progress.next_seed % seeds.count() : 0;
  Candidate best = is_taken_up ? *std::move(taken_up)
                               : search.Solve(seeds.Make(0), request.initial ? Stages::kWithLimits
                                                                             : Stages::kBoth);
  // What runs is not given up for what exceeds a limit or touches something, if it does neither;
  // but for much more clearance at a little more speed.
  if (request.initial && !is_taken_up && !(best.verdict.is_free() && best.verdict.keeps_limits)) {
    Candidate running = search.LeaveAsItIs(MakeWarmStart(request));
    const bool is_worth_it =
        best.verdict.is_free() && best.verdict.limit_share < kMuchTooFast &&
        best.verdict.clearance.least_m > running.verdict.clearance.least_m + kMuchClearer_m;
    if (!is_worth_it && IsBetter(running.verdict, best.verdict)) best = std::move(running);
  }
  if (!best.verdict.is_free() && LeadsToGoal(request)) {
    if (std::optional<PlanRequest> nearby = WithFreeGoal(request)) {
      nearby->budget = request.budget.WhatIsLeft(search.spent());
      PlanAnswer answer = Near(TryAll(*nearby, judge));
      answer.iterations += search.iterations();
      answer.spent += search.spent();
      return answer;
    }
  }
  SearchProgress progress;
  bool is_trial = false;  // of best: has had few iterations
  for (int i = is_taken_up ? 0 : 1; i < seeds.count(); ++i) {
    const int seed = (first + i) % seeds.count();
    const bool is_good = best.verdict.is_free() &&
                         (request.initial || seeds.IsDetour(seed) || best.verdict.keeps_limits);
    if (is_good) continue;
    if (search.IsSpent()) {
      progress = {true, seed, TimedPlan{*best.answer.trajectory, request.start}};
      break;
    }
    Candidate other = search.Solve(seeds.Make(seed), Stages::kBoth, &best.verdict.clearance);
    if (!IsBetter(other.verdict, best.verdict)) continue;
    best = std::move(other);
    is_trial = true;
  }
  // Only one that is finished tells whether it keeps its limits.
  if (is_trial && best.verdict.is_free() && !best.verdict.keeps_limits && !best.answer.converged &&
      !search.IsSpent()) {
    Candidate finished = search.Finish(best);
    if (IsBetter(finished.verdict, best.verdict)) best = std::move(finished);
  }
  progress.cut_short = progress.cut_short || search.was_cut_short();
  PlanAnswer answer = std::move(best.answer);
  answer.iterations = search.iterations();
  answer.spent = search.spent();
  answer.progress = std::move(progress);
  return answer;
}

}  // namespace sidestep::planner
