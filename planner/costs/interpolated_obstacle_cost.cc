#include "sidestep/planner/costs/interpolated_obstacle_cost.h"

#include <Eigen/Core>

namespace sidestep::planner {
namespace {

// d h / d (q, v) of one end, whose share in q(tau) is weight(0) q + weight(1) v.
void SetJacobian(const RowMajorMatrix& dh_dq, const Eigen::RowVector2d& weight, double* jacobian) {
  const Eigen::Index n = dh_dq.cols();
  Eigen::Map<RowMajorMatrix> J(jacobian, dh_dq.rows(), 2 * n);
  J.leftCols(n) = weight(0) * dh_dq;
  J.rightCols(n) = weight(1) * dh_dq;
}

}  // namespace

InterpolatedObstacleCost::InterpolatedObstacleCost(ObstacleHinge& hinge,
                                                   const GpInterpolation& interpolation,
                                                   EpisodeTime t)
    : hinge_(hinge), lambda_(interpolation.Lambda.row(0)), psi_(interpolation.Psi.row(0)), t_(t) {
  set_num_residuals(hinge.num_residuals());
  *mutable_parameter_block_sizes() = {2 * hinge.num_joints(), 2 * hinge.num_joints()};
}

bool InterpolatedObstacleCost::Evaluate(double const* const* parameters, double* residuals,
                                        double** jacobians) const {
  const int n = hinge_.num_joints();
  const bool with_jacobian =
      jacobians != nullptr && (jacobians[0] != nullptr || jacobians[1] != nullptr);
  const Eigen::Map<const Eigen::MatrixX2d> x0(parameters[0], n, 2), x1(parameters[1], n, 2);
  hinge_.Evaluate(x0 * lambda_.transpose() + x1 * psi_.transpose(), t_, with_jacobian);
  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = hinge_.residuals();
  if (with_jacobian && jacobians[0] != nullptr) {
    SetJacobian(hinge_.residual_jacobian(), lambda_, jacobians[0]);
  }
  if (with_jacobian && jacobians[1] != nullptr) {
    SetJacobian(hinge_.residual_jacobian(), psi_, jacobians[1]);
  }
  return true;
}

}  // namespace sidestep::planner
