#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace sidestep::planner {

/// Keeps a support state within bounds on position and velocity: per component
///   r = weight max(0, x - upper, lower - x),
/// whose square is C1. Parameters: one block, the state x = (q, v), shape 2n. Residuals: shape 2n.
class StateLimitCost final : public ceres::CostFunction {
 public:
  /// @param lower, upper bounds of (q, v), shape 2n; infinite where there is none.
  /// @param weight of each component, shape 2n [1/rad, s/rad].
  StateLimitCost(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                 const Eigen::VectorXd& weight);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::VectorXd lower_, upper_, weight_;
};

}  // namespace sidestep::planner
