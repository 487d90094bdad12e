#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace sidestep::planner {

/// Keeps the acceleration within one interval bounded. The motion there is a cubic, its
/// acceleration linear in time and greatest at an end; with dt the interval's length
///   a(0)  = -6/dt^2 (q0 - q1) - (4 v0 + 2 v1)/dt,
///   a(dt) =  6/dt^2 (q0 - q1) + (2 v0 + 4 v1)/dt,
/// and per joint and end r = weight max(0, |a| - a_max), whose square is C1.
/// Parameters: two blocks, the states (q, v) at the interval's begin and end, shape 2n each.
/// Residuals: shape 2n, first the begin.
class AccelerationLimitCost final : public ceres::CostFunction {
 public:
  /// @param a_max [rad/s^2] shape n, infinite where there is no limit.
  /// @param weight of each joint, shape n [s^2/rad].
  AccelerationLimitCost(double dt_s, const Eigen::VectorXd& a_max, const Eigen::VectorXd& weight);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double dt_s_;
  Eigen::VectorXd a_max_, weight_;
};

}  // namespace sidestep::planner
