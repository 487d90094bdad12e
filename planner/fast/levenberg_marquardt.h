#pragma once

#include <Eigen/Core>
#include <optional>

#include "sidestep/planner/objective/chain_quadratic.h"
#include "sidestep/planner/objective/trajectory_objective.h"
#include "sidestep/planner/trajectory_optimizer.h"
#include "sidestep/sdf/aligned_vector.h"

namespace sidestep::planner {

/// Levenberg-Marquardt on a trajectory's free states: each iteration one block tridiagonal solve
/// and one evaluation of the objective, which gives cost, gradient and Hessian at once.
///
/// Its rules are Ceres' own (version 2.1, trust_region_minimizer.cc, with non-monotonic steps, and
/// Ceres' default options), so that Ceres is its oracle: the same iterations to the same costs.
class LevenbergMarquardt {
 public:
  enum class Ending {
    kLikeCeres,  ///< for comparison
    /// A last step that lowers the cost is kept, which Ceres discards; and the end comes as soon as
    /// it is known that no more is to be had than the tolerance: by the gradient (SmoothnessBound)
    /// or by what a step promises, without taking it.
    kSooner
  };
  /// `objective` is borrowed.
  explicit LevenbergMarquardt(TrajectoryObjective& objective, Ending ending = Ending::kSooner);

  /// Improves `states` (2n x K), until an iteration changes the cost by no more than
  /// `function_tolerance` of it.
  SolveOutcome Solve(int max_iterations, double function_tolerance, Eigen::MatrixXd& states,
                     const PlanBudget& budget = {});

  /// The objective at the states that the last solve ended at.
  const PlanCost& cost() const { return cost_; }

 private:
  double LargestGradient() const;
  /// The scales of the unknowns, from the first Hessian.
  void ChooseScales();
  void ChooseDamping(double radius);

  TrajectoryObjective& objective_;
  Ending ending_;
  ChainQuadratic present_;
  std::optional<ChainQuadratic> candidate_;  // made for the first step
  ChainSolver solver_;
  sdf::AlignedVector<double> scale_, damping_, step_;
  PlanCost cost_;
};

}  // namespace sidestep::planner
