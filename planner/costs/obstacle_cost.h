#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

#include "sidestep/core/time.h"
#include "sidestep/planner/costs/obstacle_hinge.h"

namespace sidestep::planner {

/// Keeps the robot's spheres away from obstacles at one support state: the hinges of
/// obstacle_hinge.h at q and the state's time.
/// Parameters: one block, the state (q, v), shape 2n. Residuals: those of the
/// hinge, plain or condensed. Jacobian: analytic.
class ObstacleCost final : public ceres::CostFunction {
 public:
  /// `hinge` is borrowed; costs that are evaluated in turn may share it.
  ObstacleCost(ObstacleHinge& hinge, EpisodeTime t);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  ObstacleHinge& hinge_;
  EpisodeTime t_;
};

}  // namespace sidestep::planner
