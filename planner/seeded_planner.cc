#include "sidestep/planner/seeded_planner.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/seeds.h"

namespace sidestep::planner {
namespace {

// Of each stage of a further seed. Those that lead anywhere do so soon; what is left to be had, the
// next cycle gets from a warm start.
constexpr int kTrialIterations = 12;

constexpr double kColdTolerance = 1e-3;  // of the first stage, whose result is only a start

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
    return SolveWithLimits(MostTrialIterations());
  }

  /// With `to_beat` it is a trial, for one of many seeds: few iterations, and it gives up after the
  /// first stage if that touches something and is not safer.
  Candidate Solve(const Trajectory& guess, Stages stages, const Clearance* to_beat = nullptr) {
    optimizer_->Restart(guess);
    const int max_iterations = to_beat ? MostTrialIterations() : planner_.gp().max_iterations;
    if (stages != Stages::kWithLimits) Improve(max_iterations, kColdTolerance);
    if (to_beat) {
      PlanAnswer answer;
      answer.trajectory = optimizer_->GetTrajectory();
      Candidate first = Judged(std::move(answer));
      if (!first.verdict.is_free() && !IsSafer(first.verdict.clearance, *to_beat)) return first;
    }
    return SolveWithLimits(max_iterations);
  }

 private:
  int MostTrialIterations() const {
    return std::min(kTrialIterations, planner_.gp().max_iterations);
  }

  Candidate SolveWithLimits(int max_iterations) {
    optimizer_->AddLimits();
    const bool converged = Improve(max_iterations, planner_.gp().function_tolerance);
    PlanAnswer answer;
    answer.trajectory = optimizer_->GetTrajectory();
    answer.converged = converged;
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
  Seeds seeds(request, gp_.num_detours);
  std::optional<Candidate> best = search.TakeUp();
  const int first = best ? request.progress.next_seed % seeds.count() : 0;
  SearchProgress progress;
  for (int i = 0; i < seeds.count(); ++i) {
    const int seed = (first + i) % seeds.count();
    if (!best) {
      best = search.Solve(seeds.Make(seed), request.initial ? Stages::kWithLimits : Stages::kBoth);
      continue;
    }
    const bool is_good = best->verdict.is_free() &&
                         (request.initial || seeds.IsDetour(seed) || IsWithinLimits(best->verdict));
    if (is_good) continue;
    if (search.IsSpent()) {
      progress = {true, seed, TimedPlan{*best->answer.trajectory, request.start}};
      break;
    }
    Candidate other = search.Solve(seeds.Make(seed), Stages::kBoth, &best->verdict.clearance);
    if (IsBetter(other.verdict, best->verdict)) best = std::move(other);
  }
  progress.cut_short = progress.cut_short || search.was_cut_short();
  PlanAnswer answer = std::move(best->answer);
  answer.iterations = search.iterations();
  answer.spent = search.spent();
  answer.progress = std::move(progress);
  return answer;
}

}  // namespace sidestep::planner
