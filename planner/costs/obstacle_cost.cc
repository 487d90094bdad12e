#include "sidestep/planner/costs/obstacle_cost.h"

namespace sidestep::planner {

ObstacleCost::ObstacleCost(ObstacleHinge& hinge, EpisodeTime t) : hinge_(hinge), t_(t) {
  set_num_residuals(hinge.num_residuals());
  *mutable_parameter_block_sizes() = {2 * hinge.num_joints()};
}

bool ObstacleCost::Evaluate(double const* const* parameters, double* residuals,
                            double** jacobians) const {
  const int n = hinge_.num_joints();
  const bool with_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
  hinge_.Evaluate(Eigen::Map<const Eigen::VectorXd>(parameters[0], n), t_, with_jacobian);
  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = hinge_.residuals();
  if (with_jacobian) {
    Eigen::Map<RowMajorMatrix> J(jacobians[0], num_residuals(), 2 * n);
    J.leftCols(n) = hinge_.residual_jacobian();
    J.rightCols(n).setZero();
  }
  return true;
}

}  // namespace sidestep::planner
