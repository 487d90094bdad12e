#include "sidestep/planner/gauss_newton_planner.h"

#include <utility>

#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/gauss_newton.h"

namespace sidestep::planner {

GaussNewtonPlanner::GaussNewtonPlanner(const robot::RobotModel& robot,
                                       const PlannerSettings& settings, const GpSettings& gp)
    : Planner(robot, settings), gp_(gp) {}

PlanAnswer GaussNewtonPlanner::DoPlan(const PlanRequest& request, PlanJudge&) const {
  const Trajectory guess =
      request.initial ? MakeWarmStart(request) : MakeDirectMotion(request, Timing::kWholeTime);
  GaussNewtonOptions options;
  options.epsilon_m = settings().epsilon_m;
  options.sigma_obs = gp_.sigma_obs;
  options.num_interpolated = gp_.num_interpolated;
  options.qc = gp_.qc;
  options.max_iterations = gp_.max_iterations;
  options.budget = request.budget;
  options.relative_decrease = gp_.function_tolerance;

  // States before the last fixed one decide nothing.
  const int num_fixed = request.num_fixed, num_solved = request.num_states - num_fixed + 1;
  GaussNewton problem(
      robot(),
      {guess.t_s.tail(num_solved), guess.q.rightCols(num_solved), guess.v.rightCols(num_solved)},
      options);
  problem.AddPrior(0, guess.q.col(num_fixed - 1), guess.v.col(num_fixed - 1), gp_.sigma_goal);
  problem.AddPrior(num_solved - 1, request.q_goal, Eigen::VectorXd::Zero(robot().num_joints()),
                   gp_.sigma_goal);
  for (int k = 1; k < num_solved; ++k) problem.SetField(k, *request.field, request.start);
  const GaussNewtonSummary summary = problem.Solve();

  Trajectory found = guess;  // whose fixed states stay to the bit
  found.q.rightCols(num_solved - 1) = problem.GetTrajectory().q.rightCols(num_solved - 1);
  found.v.rightCols(num_solved - 1) = problem.GetTrajectory().v.rightCols(num_solved - 1);
  return {.trajectory = std::move(found),
          .converged = summary.converged,
          .iterations = summary.iterations(),
          .cost = problem.ComputeCost()};
}

PlannerKind GaussNewtonKind() {
  return KindOf<GaussNewtonPlanner>(
      "the solver of the published experiments: full Gauss-Newton steps, no damping",
      SingleSolveParameters());
}

}  // namespace sidestep::planner
