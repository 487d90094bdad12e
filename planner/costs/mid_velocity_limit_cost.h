#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace sidestep::planner {

/// Keeps the velocity in the middle of an interval bounded. With bounds at the support states alone
/// the cubic between two of them bulges beyond. With dt the interval's length
///   v(dt/2) = 3/2 (q1 - q0)/dt - (v0 + v1)/4,
/// and per joint r = weight max(0, |v| - v_max), whose square is C1.
/// Parameters: two blocks, the states (q, v) at the interval's begin and end, shape 2n each.
/// Residuals: shape n.
class MidVelocityLimitCost final : public ceres::CostFunction {
 public:
  /// @param v_max [rad/s] shape n, infinite where there is no limit.
  /// @param weight of each joint, shape n [s/rad].
  MidVelocityLimitCost(double dt_s, const Eigen::VectorXd& v_max, const Eigen::VectorXd& weight);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double dt_s_;
  Eigen::VectorXd v_max_, weight_;
};

}  // namespace sidestep::planner
