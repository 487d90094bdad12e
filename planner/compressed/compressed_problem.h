#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/objective/chain_quadratic.h"
#include "sidestep/planner/objective/trajectory_objective.h"
#include "sidestep/planner/planner.h"

namespace sidestep::planner {

/// Rows (J, r) that stand for a quadratic: of n unknowns, n + 1 rows R with R^T R = `normal`, which
/// is (J, r)^T (J, r). A least-squares solver that sees them finds the same cost, gradient and
/// Gauss-Newton Hessian. By Cholesky; what is linearly dependent on rows above gives a row of
/// zeros.
/// @param normal lower triangle, (n + 1) x (n + 1), positive semidefinite but for rounding; R on
/// return, upper triangular.
void CompressNormal(Eigen::Ref<Eigen::MatrixXd> normal);

/// The objective as a least-squares problem for Ceres with as few and as small residual blocks as
/// it has intervals, each of 4n + 1 rows, however many obstacle costs lie in one.
///
/// The whole objective is evaluated once for each point that Ceres looks at, by its callback.
class CompressedProblem final : private ceres::EvaluationCallback {
 public:
  /// `objective` is borrowed, and has been restarted from `states`; its limits may come later.
  CompressedProblem(TrajectoryObjective& objective, const Eigen::MatrixXd& states);
  CompressedProblem(const CompressedProblem&) = delete;
  CompressedProblem& operator=(const CompressedProblem&) = delete;
  ~CompressedProblem() override = default;

  ceres::Problem& problem() { return *problem_; }
  const Eigen::MatrixXd& states() const { return states_; }  ///< 2n x K

 private:
  class StepCost;
  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

  TrajectoryObjective& objective_;
  Eigen::MatrixXd states_;
  std::vector<std::unique_ptr<ceres::CostFunction>> costs_;
  std::unique_ptr<ceres::Problem> problem_;  // last: it must go first
};

}  // namespace sidestep::planner
