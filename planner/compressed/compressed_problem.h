#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sidestep/planner/objective/chain_quadratic.h"
#include "sidestep/planner/objective/trajectory_objective.h"
#include "sidestep/sdf/aligned_vector.h"

namespace sidestep::planner {

/// The objective as a least-squares problem for Ceres with as few and as small residual blocks as
/// can be, however many costs lie in an interval.
///
/// Of each step (a state and the interval before it) the costs' rows (J, r) give way to the
/// Cholesky factor R of (J, r)^T (J, r), which is 4n + 1 rows: a solver that sees them finds the
/// same cost, gradient and Gauss-Newton Hessian. The first 2n of them depend on both states, the
/// others on the second alone: two residual blocks.
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
  class Rows;
  /// The rows of one step, row by row: column j of R^T is row j of (J, r).
  struct Step {
    double cost = 0;
    sdf::AlignedVector<double> rows;
  };

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;

  TrajectoryObjective& objective_;
  Eigen::MatrixXd states_;
  int height_;                // numbers from one row to the next
  ChainQuadratic quadratic_;  // of one step
  std::vector<Step> steps_;   // of the free states
  std::vector<std::unique_ptr<ceres::CostFunction>> costs_;
  std::unique_ptr<ceres::Problem> problem_;  // last: it must go first
};

}  // namespace sidestep::planner
