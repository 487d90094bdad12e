#include "sidestep/planner/seeded_planner.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "sidestep/planner/first_guess.h"

namespace sidestep::planner {
namespace {

// Of each stage of a further seed. Those that lead anywhere do so soon; what is left to be had, the
// next cycle gets from a warm start.
constexpr int kTrialIterations = 12;

constexpr double kColdTolerance = 1e-3;  // of the first stage, whose result is only a start

EpisodeTime FirstFreeTime(const PlanRequest& request) {
  return request.start + HorizonOffset(request.num_fixed * request.step_s);
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
  bool IsSpent() const { return request_.budget.IsSpent(iterations_); }

  /// With `to_beat` it is a trial, for one of many seeds: few iterations, and it gives up after the
  /// first stage if that touches something and is not safer.
  Candidate Solve(const Trajectory& guess, Stages stages, const Clearance* to_beat = nullptr) {
    optimizer_->Restart(guess);
    const int max_iterations = to_beat ? std::min(kTrialIterations, planner_.gp().max_iterations)
                                       : planner_.gp().max_iterations;
    if (stages != Stages::kWithLimits) Improve(max_iterations, kColdTolerance);
    if (to_beat) {
      Candidate first = Judged({.trajectory = optimizer_->GetTrajectory()});
      if (!first.verdict.is_free() && !IsSafer(first.verdict.clearance, *to_beat)) return first;
    }
    optimizer_->AddLimits();
    const bool converged = Improve(max_iterations, planner_.gp().function_tolerance);
    return Judged({.trajectory = optimizer_->GetTrajectory(),
                   .converged = converged,
                   .cost = optimizer_->ComputeCost()});
  }

 private:
  bool Improve(int max_iterations, double function_tolerance) {
    const int left = request_.budget.iterations - iterations_;
    const SolveOutcome outcome =
        optimizer_->Solve(std::min(max_iterations, left), function_tolerance);
    iterations_ += outcome.iterations;
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
  int iterations_ = 0;
};

bool SeededPlanner::IsWithinLimits(const Verdict& verdict) const {
  return KeepsWholeLimits(verdict.limit_use, settings());
}

bool SeededPlanner::IsBetter(const Verdict& a, const Verdict& b) const {
  const auto rank = [this](const Verdict& verdict) {
    return !verdict.is_free() ? 0 : IsWithinLimits(verdict) ? 2 : 1;
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  return IsSafer(a.clearance, b.clearance);
}

PlanAnswer SeededPlanner::DoPlan(const PlanRequest& request, PlanJudge& judge) const {
  Search search(*this, request, judge);
  std::vector<Timing> timings = {Timing::kWholeTime, Timing::kLeaveLate, Timing::kArriveEarly};
  Candidate best;
  if (request.initial) {
    best = search.Solve(MakeWarmStart(request), Stages::kWithLimits);
  } else {
    best = search.Solve(MakeDirectMotion(request, timings.front()), Stages::kBoth);
    timings.erase(timings.begin());
  }
  const auto attempt = [&](const Trajectory& guess) {
    Candidate other = search.Solve(guess, Stages::kBoth, &best.verdict.clearance);
    if (IsBetter(other.verdict, best.verdict)) best = std::move(other);
  };
  for (const Timing timing : timings) {
    const bool is_good =
        best.verdict.is_free() && (request.initial || IsWithinLimits(best.verdict));
    if (is_good || search.IsSpent()) break;
    attempt(MakeDirectMotion(request, timing));
  }
  // A warm start has less time for one. Other ones a cycle later: who waits without a way out tries
  // more and more of them.
  const int num_detours = request.initial ? 0 : gp_.num_detours;
  RandomStream random(std::bit_cast<std::uint64_t>(FirstFreeTime(request).seconds()), "detours");
  for (int i = 0; i < num_detours && !best.verdict.is_free() && !search.IsSpent(); ++i) {
    attempt(MakeDetour(request, random));
  }
  best.answer.iterations = search.iterations();
  return std::move(best.answer);
}

}  // namespace sidestep::planner
