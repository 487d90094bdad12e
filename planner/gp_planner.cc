#include "planner/gp_planner.h"

#include <ceres/solver.h>

#include <utility>

#include "planner/first_guess.h"
#include "planner/gp_problem.h"

namespace sidestep {
namespace {

// Weights of the limit costs: strong beside the obstacle cost (1 / sigma = 20 per metre), and soft
// enough for Levenberg-Marquardt.
constexpr double kPositionWeight = 1e3;
constexpr double kVelocityWeight = 1e3;
constexpr double kAccelerationWeight = 1e2;

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

// Whether `a` is the better plan: free within limits before free before not free; then the wider.
bool IsBetter(const PlanResult& a, const PlanResult& b) {
  const auto rank = [](const PlanResult& plan) {
    return plan.min_clearance_m <= 0 ? 0 : plan.limit_use > 1 ? 1 : 2;
  };
  if (rank(a) != rank(b)) return rank(a) > rank(b);
  return a.min_clearance_m > b.min_clearance_m;
}

bool IsGood(const PlanResult& plan) { return plan.min_clearance_m > 0 && plan.limit_use <= 1; }

}  // namespace

GpPlanner::GpPlanner(const RobotModel& robot, const PlannerSettings& settings)
    : Planner(robot), settings_(settings) {
  CheckPlannerSettings(settings);
}

PlanResult GpPlanner::Solve(const PlanRequest& request, const Trajectory& guess, bool warm) const {
  GpProblemOptions options;
  options.epsilon_m = settings_.epsilon_m;
  options.sigma_obs = settings_.sigma_obs;
  options.num_interpolated = settings_.num_interpolated;
  options.qc = settings_.qc;
  options.sigma_goal = settings_.sigma_goal;
  LimitWeights limits;
  if (settings_.position_limits) limits.position = kPositionWeight;
  if (settings_.velocity_limits) limits.velocity = kVelocityWeight;
  if (settings_.acceleration_limits) limits.acceleration = kAccelerationWeight;

  GpProblem problem(robot(), request, guess, options);
  SolveOutcome first_stage;
  if (!warm) {
    first_stage =
        SolveByLevenbergMarquardt(problem.problem(), settings_.max_iterations, kColdTolerance);
  }
  problem.AddLimits(limits, settings_.limit_scale);
  const SolveOutcome outcome = SolveByLevenbergMarquardt(
      problem.problem(), settings_.max_iterations, settings_.function_tolerance);

  PlanResult result = Judge(request, problem.GetTrajectory(), outcome.converged);
  result.iterations = first_stage.iterations + outcome.iterations;
  result.cost = problem.ComputeCost();
  return result;
}

PlanResult GpPlanner::DoPlan(const PlanRequest& request) const {
  PlanResult best = request.initial ? Solve(request, MakeWarmStart(request), /*warm=*/true)
                                    : Solve(request, MakeDirectMotion(request, Timing::kWholeTime),
                                            /*warm=*/false);
  int iterations = best.iterations;
  for (const Timing timing : {Timing::kWholeTime, Timing::kLeaveLate, Timing::kArriveEarly}) {
    if (IsGood(best)) break;
    if (timing == Timing::kWholeTime && !request.initial) continue;  // has been tried
    PlanResult other = Solve(request, MakeDirectMotion(request, timing), /*warm=*/false);
    iterations += other.iterations;
    if (IsBetter(other, best)) best = std::move(other);
  }
  best.iterations = iterations;
  return best;
}

}  // namespace sidestep
