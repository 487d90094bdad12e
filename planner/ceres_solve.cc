#include "sidestep/planner/ceres_solve.h"

#include <ceres/solver.h>

namespace sidestep::planner {
namespace {

// Ends a solve, with the best so far, where time is up.
class BudgetWatch final : public ceres::IterationCallback {
 public:
  explicit BudgetWatch(const PlanBudget& budget) : budget_(budget) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return budget_.IsTimeUp() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const PlanBudget& budget_;
};

}  // namespace

SolveOutcome SolveByLevenbergMarquardt(ceres::Problem& problem, int max_iterations,
                                       double function_tolerance, const PlanBudget& budget,
                                       ceres::IterationCallback* may_end) {
  BudgetWatch watch(budget);
  ceres::Solver::Options options;
  options.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.use_nonmonotonic_steps = true;
  options.num_threads = 1;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = function_tolerance;
  options.logging_type = ceres::SILENT;
  options.callbacks = {&watch};
  if (may_end != nullptr) {
    options.callbacks.push_back(may_end);
    options.update_state_every_iteration = true;
  }
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const bool was_ended = summary.termination_type == ceres::USER_SUCCESS && !budget.IsTimeUp();
  return {static_cast<int>(summary.iterations.size()) - 1,
          summary.termination_type == ceres::CONVERGENCE || was_ended};
}

}  // namespace sidestep::planner
