#pragma once

#include <ceres/cost_function.h>

#include "sidestep/core/time.h"
#include "sidestep/planner/costs/obstacle_hinge.h"
#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {

/// Keeps the robot's spheres away from obstacles between two support states: the hinges of
/// obstacle_hinge.h at the configuration that the GP interpolates,
///   q(tau) = lambda_1 q0 + lambda_2 v0 + psi_1 q1 + psi_2 v1   (top rows of Lambda and Psi).
/// Parameters: two blocks, the states (q, v) at the interval's begin and end, shape 2n each.
/// Residuals: those of the hinge, plain or condensed. Jacobian: analytic, by the chain rule onto
/// the four vectors.
class InterpolatedObstacleCost final : public ceres::CostFunction {
 public:
  /// @param t the time of the interpolated configuration.
  /// `hinge` is borrowed; costs that are evaluated in turn may share it.
  InterpolatedObstacleCost(ObstacleHinge& hinge, const GpInterpolation& interpolation,
                           EpisodeTime t);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  ObstacleHinge& hinge_;
  Eigen::RowVector2d lambda_;
  Eigen::RowVector2d psi_;
  EpisodeTime t_;
};

}  // namespace sidestep::planner
