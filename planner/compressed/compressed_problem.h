#pragma once

#include <ceres/cost_function.h>
#include <ceres/evaluation_callback.h>
#include <ceres/problem.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sidestep/planner/compressed/chain_rows.h"
#include "sidestep/planner/objective/chain_quadratic.h"
#include "sidestep/planner/objective/trajectory_objective.h"

namespace sidestep::planner {

/// The objective as a least-squares problem for Ceres with as few and as small residual blocks as
/// can be, however many costs lie in an interval.
///
/// Its parameters are the free states. The rows (J, r) of all costs give way to the Cholesky factor
/// of their Gauss-Newton Hessian, 2n rows a state, each in that state and the next (ChainRows): a
/// solver that sees them finds the same cost, gradient and Hessian. What is left of the cost is one
/// row more, which no state changes.
///
/// The whole objective is evaluated once for each point that is looked at, whoever asks.
class CompressedProblem final : private ceres::EvaluationCallback {
 public:
  /// `objective` is borrowed, and has been restarted from `states` (2n x K).
  CompressedProblem(TrajectoryObjective& objective, const Eigen::MatrixXd& states);
  CompressedProblem(const CompressedProblem&) = delete;
  CompressedProblem& operator=(const CompressedProblem&) = delete;
  ~CompressedProblem() override = default;

  /// To be called when the objective's limits have changed.
  void ForgetWhatWasSeen() { is_seen_ = false; }

  /// At the present states.
  const PlanCost& Cost();
  /// Whether no step promises to lower the cost by more than this share of it.
  bool IsBest(double tolerance);

  /// Made when it is first asked for: a solve that has nothing to do needs none.
  ceres::Problem& problem();
  const Eigen::MatrixXd& states() const { return states_; }  ///< 2n x K

 private:
  class Rows;

  void PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) override;
  void Look();
  /// @return false where the Hessian is not positive definite.
  bool HasRows();

  TrajectoryObjective& objective_;
  Eigen::MatrixXd states_;
  bool is_seen_ = false, is_factored_ = false, has_rows_ = false;  // of seen_at_
  Eigen::MatrixXd seen_at_;                                        // what the quadratic is about
  ChainQuadratic quadratic_;
  ChainRows rows_;
  std::vector<std::unique_ptr<ceres::CostFunction>> costs_;
  std::unique_ptr<ceres::Problem> problem_;  // last: it must go first
};

}  // namespace sidestep::planner
