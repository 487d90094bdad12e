#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

namespace sidestep::planner {

/// The Gaussian-process prior of one interval: r = W (Phi x0 - x1), shape 2n (first the n rows of
/// position, then those of velocity), whose half square is the GP cost of that interval.
/// Parameters: two blocks, the states (q, v) at its begin and end, shape 2n each. The Jacobian is
/// constant.
/// Source: Mukadam et al., IJRR 37(11):1319-1340, 2018, eq. 15; W as in gp_trajectory.h.
class GpPriorCost final : public ceres::CostFunction {
 public:
  GpPriorCost(int num_joints, double dt_s, double qc);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  int num_joints_;
  Eigen::Matrix2d W_Phi_;
  Eigen::Matrix2d W_;
};

}  // namespace sidestep::planner
