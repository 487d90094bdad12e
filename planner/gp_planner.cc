#include "sidestep/planner/gp_planner.h"

#include <ceres/solver.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/gp_problem.h"

namespace sidestep::planner {
namespace {

// Weights of the limit costs [1/rad, s/rad, s^2/rad]. In the walkway scene at 1.2 to 2.0 m/s plans
// exceed the scaled limits by at most 2 % of the limit, which the scales leave room for; ten times
// the weights take two to three times the iterations for the same plans.
constexpr double kPositionWeight = 1000;
constexpr double kVelocityWeight = 30;
constexpr double kAccelerationWeight = 5;

// Links keep this far apart: spheres leave gaps between them and the shapes (docs/robots.md).
constexpr double kSelfEpsilon_m = 0.05;

// Of each stage of a further seed. Those that lead anywhere do so soon; what is left to be had, the
// next cycle gets from a warm start.
constexpr int kTrialIterations = 12;

constexpr double kColdTolerance = 1e-3;  // of the first stage, whose result is only a start

struct SolveOutcome {
  int iterations = 0;
  bool converged = false;
};

// Ends a solve, with the best so far, where a budget of another kind than iterations is spent.
class BudgetWatch final : public ceres::IterationCallback {
 public:
  explicit BudgetWatch(const PlanBudget& budget) : budget_(budget) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return budget_.IsSpent(0) ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const PlanBudget& budget_;
};

SolveOutcome SolveByLevenbergMarquardt(ceres::Problem& problem, int max_iterations,
                                       double function_tolerance, const PlanBudget& budget) {
  BudgetWatch watch(budget);
  ceres::Solver::Options options;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // keeps system BLAS out
  options.use_nonmonotonic_steps = true;  // the gradient of a trilinear field jumps at cell faces
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = function_tolerance;
  options.logging_type = ceres::SILENT;
  options.callbacks = {&watch};
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {static_cast<int>(summary.iterations.size()) - 1,
          summary.termination_type == ceres::CONVERGENCE};
}

EpisodeTime FirstFreeTime(const PlanRequest& request) {
  return request.start + HorizonOffset(request.num_fixed * request.step_s);
}

}  // namespace

GpPlanner::GpPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
                     const GpSettings& gp)
    : Planner(robot, settings), gp_(gp) {}

GpPlanner::Candidate GpPlanner::Solve(const PlanRequest& request, PlanJudge& judge,
                                      const Trajectory& guess, Stages stages, int iterations_done,
                                      const Clearance* to_beat) const {
  GpProblemOptions options;
  options.epsilon_m = settings().epsilon_m;
  options.sigma_obs = gp_.sigma_obs;
  options.num_interpolated = gp_.num_interpolated;
  options.qc = gp_.qc;
  options.sigma_goal = gp_.sigma_goal;
  options.self_epsilon_m = kSelfEpsilon_m;
  options.condensed = true;
  LimitWeights limits;
  if (settings().position_limits) limits.position = kPositionWeight;
  if (settings().velocity_limits) limits.velocity = kVelocityWeight;
  if (settings().acceleration_limits) limits.acceleration = kAccelerationWeight;

  GpProblem problem(robot(), request, guess, options);
  PlanAnswer answer;
  const int max_iterations =
      to_beat ? std::min(kTrialIterations, gp_.max_iterations) : gp_.max_iterations;
  const auto solve = [&](double function_tolerance) {
    const int left = request.budget.iterations - iterations_done - answer.iterations;
    if (left <= 0) return false;
    const SolveOutcome outcome = SolveByLevenbergMarquardt(
        problem.problem(), std::min(max_iterations, left), function_tolerance, request.budget);
    answer.iterations += outcome.iterations;
    return outcome.converged;
  };
  const auto judged = [&] {
    answer.trajectory = problem.GetTrajectory();
    return Candidate{answer, judge.Judge(*answer.trajectory)};
  };
  if (stages != Stages::kWithLimits) solve(kColdTolerance);
  if (to_beat) {
    const Candidate first = judged();
    if (!first.verdict.is_free() && !IsSafer(first.verdict.clearance, *to_beat)) return first;
  }
  problem.AddLimits(limits, settings().velocity_scale, settings().acceleration_scale);
  answer.converged = solve(gp_.function_tolerance);
  answer.cost = problem.ComputeCost();
  return judged();
}

bool GpPlanner::IsWithinLimits(const Verdict& verdict) const {
  const LimitUse& use = verdict.limit_use;
  return (!settings().position_limits || use.position <= 1) &&
         (!settings().velocity_limits || use.velocity <= 1) &&
         (!settings().acceleration_limits || use.acceleration <= 1);
}

bool GpPlanner::IsBetter(const Verdict& a, const Verdict& b) const {
  const auto rank = [this](const Verdict& verdict) {
    return !verdict.is_free() ? 0 : IsWithinLimits(verdict) ? 2 : 1;
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  return IsSafer(a.clearance, b.clearance);
}

PlanAnswer GpPlanner::DoPlan(const PlanRequest& request, PlanJudge& judge) const {
  std::vector<Timing> timings = {Timing::kWholeTime, Timing::kLeaveLate, Timing::kArriveEarly};
  Candidate best;
  if (request.initial) {
    best = Solve(request, judge, MakeWarmStart(request), Stages::kWithLimits, 0);
  } else {
    best = Solve(request, judge, MakeDirectMotion(request, timings.front()), Stages::kBoth, 0);
    timings.erase(timings.begin());
  }
  int iterations = best.answer.iterations;
  const auto attempt = [&](const Trajectory& guess) {
    if (request.budget.IsSpent(iterations)) return;
    Candidate other =
        Solve(request, judge, guess, Stages::kBoth, iterations, &best.verdict.clearance);
    iterations += other.answer.iterations;
    if (IsBetter(other.verdict, best.verdict)) best = std::move(other);
  };
  for (const Timing timing : timings) {
    if (best.verdict.is_free() && (request.initial || IsWithinLimits(best.verdict))) break;
    attempt(MakeDirectMotion(request, timing));
  }
  // A warm start has less time for one. Other ones a cycle later: who waits without a way out tries
  // more and more of them.
  const int num_detours = request.initial ? 0 : gp_.num_detours;
  RandomStream random(std::bit_cast<std::uint64_t>(FirstFreeTime(request).seconds()), "detours");
  for (int i = 0; i < num_detours && !best.verdict.is_free(); ++i) {
    attempt(MakeDetour(request, random));
  }
  best.answer.iterations = iterations;
  return std::move(best.answer);
}

PlannerKind GpmpKind() {
  return {"trajectory optimisation after GPMP2, with limits, detours and the links kept apart",
          GpParameters().declared(),
          [](const robot::RobotModel& robot, const PlannerSettings& settings,
             const Parameters& parameters) {
            return std::make_unique<GpPlanner>(robot, settings, GpParameters().Read(parameters));
          }};
}

}  // namespace sidestep::planner
