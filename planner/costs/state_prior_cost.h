#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace sidestep::planner {

/// Draws one support state to a given one: r = (x - x_desired) / sigma, shape 2n.
/// Parameters: one block, the state x = (q, v), shape 2n.
class StatePriorCost final : public ceres::CostFunction {
 public:
  /// @param sigma one for all components [rad and rad/s], > 0.
  StatePriorCost(const Eigen::VectorXd& q_desired, const Eigen::VectorXd& v_desired, double sigma);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::VectorXd x_desired_;
  double sigma_;
};

}  // namespace sidestep::planner
