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

SolveOutcome SolveByLevenbergMarquardt(ceres::Problem& problem, int max_iterations,
                                       double function_tolerance) {
  ceres::Solver::Options options;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // keeps system BLAS out
  options.use_nonmonotonic_steps = true;  // the gradient of a trilinear field jumps at cell faces
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = function_tolerance;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {static_cast<int>(summary.iterations.size()) - 1,
          summary.termination_type == ceres::CONVERGENCE};
}

EpisodeTime FirstFreeTime(const PlanRequest& request) {
  return request.start + HorizonOffset(request.num_fixed * request.step_s);
}

}  // namespace

GpPlanner::GpPlanner(const robot::RobotModel& robot, const PlannerSettings& settings)
    : Planner(robot, settings) {}

PlanResult GpPlanner::Solve(const PlanRequest& request, const Trajectory& guess, Stages stages,
                            const Clearance* to_beat) const {
  GpProblemOptions options;
  options.epsilon_m = settings().epsilon_m;
  options.sigma_obs = settings().sigma_obs;
  options.num_interpolated = settings().num_interpolated;
  options.qc = settings().qc;
  options.sigma_goal = settings().sigma_goal;
  options.self_epsilon_m = kSelfEpsilon_m;
  options.condensed = true;
  LimitWeights limits;
  if (settings().position_limits) limits.position = kPositionWeight;
  if (settings().velocity_limits) limits.velocity = kVelocityWeight;
  if (settings().acceleration_limits) limits.acceleration = kAccelerationWeight;

  GpProblem problem(robot(), request, guess, options);
  int iterations = 0;
  const int max_iterations =
      to_beat ? std::min(kTrialIterations, settings().max_iterations) : settings().max_iterations;
  const auto solve = [&](double function_tolerance) {
    const SolveOutcome outcome =
        SolveByLevenbergMarquardt(problem.problem(), max_iterations, function_tolerance);
    iterations += outcome.iterations;
    return outcome.converged;
  };
  if (stages != Stages::kWithLimits) solve(kColdTolerance);
  if (to_beat) {
    PlanResult result = MakeResult(request, problem.GetTrajectory(), /*converged=*/false);
    result.iterations = iterations;
    if (result.clearance.first_contact && !IsSafer(result.clearance, *to_beat)) return result;
  }
  problem.AddLimits(limits, settings().velocity_scale, settings().acceleration_scale);
  const bool converged = solve(settings().function_tolerance);

  PlanResult result = MakeResult(request, problem.GetTrajectory(), converged);
  result.iterations = iterations;
  result.cost = problem.ComputeCost();
  return result;
}

bool GpPlanner::IsWithinLimits(const PlanResult& plan) const {
  return (!settings().position_limits || plan.limit_use.position <= 1) &&
         (!settings().velocity_limits || plan.limit_use.velocity <= 1) &&
         (!settings().acceleration_limits || plan.limit_use.acceleration <= 1);
}

bool GpPlanner::IsBetter(const PlanResult& a, const PlanResult& b) const {
  const auto rank = [this](const PlanResult& plan) {
    return plan.clearance.first_contact ? 0 : IsWithinLimits(plan) ? 2 : 1;
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  return IsSafer(a.clearance, b.clearance);
}

PlanResult GpPlanner::DoPlan(const PlanRequest& request) const {
  std::vector<Timing> timings = {Timing::kWholeTime, Timing::kLeaveLate, Timing::kArriveEarly};
  PlanResult best;
  if (request.initial) {
    best = Solve(request, MakeWarmStart(request), Stages::kWithLimits);
  } else {
    best = Solve(request, MakeDirectMotion(request, timings.front()), Stages::kBoth);
    timings.erase(timings.begin());
  }
  int iterations = best.iterations;
  const auto attempt = [&](const Trajectory& guess) {
    PlanResult other = Solve(request, guess, Stages::kBoth, &best.clearance);
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

std::unique_ptr<Planner> MakeGpPlanner(const robot::RobotModel& robot,
                                       const PlannerSettings& settings) {
  return std::make_unique<GpPlanner>(robot, settings);
}

}  // namespace sidestep::planner
