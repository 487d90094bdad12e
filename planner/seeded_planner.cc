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

PlanResult SeededPlanner::Solve(const PlanRequest& request, TrajectoryOptimizer& optimizer,
                                const Trajectory& guess, Stages stages,
                                const Clearance* to_beat) const {
  optimizer.Restart(guess);
  int iterations = 0;
  const int max_iterations =
      to_beat ? std::min(kTrialIterations, settings().max_iterations) : settings().max_iterations;
  const auto solve = [&](double function_tolerance) {
    const SolveOutcome outcome = optimizer.Solve(max_iterations, function_tolerance);
    iterations += outcome.iterations;
    return outcome.converged;
  };
  if (stages != Stages::kWithLimits) solve(kColdTolerance);
  if (to_beat) {
    PlanResult result = MakeResult(request, optimizer.GetTrajectory(), /*converged=*/false);
    result.iterations = iterations;
    if (result.clearance.first_contact && !IsSafer(result.clearance, *to_beat)) return result;
  }
  optimizer.AddLimits();
  const bool converged = solve(settings().function_tolerance);

  PlanResult result = MakeResult(request, optimizer.GetTrajectory(), converged);
  result.iterations = iterations;
  result.cost = optimizer.ComputeCost();
  return result;
}

bool SeededPlanner::IsWithinLimits(const PlanResult& plan) const {
  return (!settings().position_limits || plan.limit_use.position <= 1) &&
         (!settings().velocity_limits || plan.limit_use.velocity <= 1) &&
         (!settings().acceleration_limits || plan.limit_use.acceleration <= 1);
}

bool SeededPlanner::IsBetter(const PlanResult& a, const PlanResult& b) const {
  const auto rank = [this](const PlanResult& plan) {
    return plan.clearance.first_contact ? 0 : IsWithinLimits(plan) ? 2 : 1;
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  return IsSafer(a.clearance, b.clearance);
}

PlanResult SeededPlanner::DoPlan(const PlanRequest& request) const {
  const std::unique_ptr<TrajectoryOptimizer> optimizer = MakeOptimizer(request);
  std::vector<Timing> timings = {Timing::kWholeTime, Timing::kLeaveLate, Timing::kArriveEarly};
  PlanResult best;
  if (request.initial) {
    best = Solve(request, *optimizer, MakeWarmStart(request), Stages::kWithLimits);
  } else {
    best = Solve(request, *optimizer, MakeDirectMotion(request, timings.front()), Stages::kBoth);
    timings.erase(timings.begin());
  }
  int iterations = best.iterations;
  const auto attempt = [&](const Trajectory& guess) {
    PlanResult other = Solve(request, *optimizer, guess, Stages::kBoth, &best.clearance);
    iterations += other.iterations;
    if (IsBetter(other, best)) best = std::move(other);
  };
  for (const Timing timing : timings) {
    if (!best.clearance.first_contact && (request.initial || IsWithinLimits(best))) break;
    attempt(MakeDirectMotion(request, timing));
  }
  // A warm start has less time for one. Other ones a cycle later: who waits without a way out tries
  // more and more of them.
  const int num_detours = request.initial ? 0 : settings().num_detours;
  RandomStream random(std::bit_cast<std::uint64_t>(FirstFreeTime(request).seconds()), "detours");
  for (int i = 0; i < num_detours && best.clearance.first_contact; ++i) {
    attempt(MakeDetour(request, random));
  }
  best.iterations = iterations;
  return best;
}

}  // namespace sidestep::planner
