#include "sidestep/planner/costs/gp_prior_cost.h"

#include "sidestep/planner/costs/state_jacobian.h"
#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {

GpPriorCost::GpPriorCost(int num_joints, double dt_s, double qc)
    : num_joints_(num_joints),
      W_Phi_(GpWhitening(dt_s, qc) * GpTransition(dt_s)),
      W_(GpWhitening(dt_s, qc)) {
  set_num_residuals(2 * num_joints);
  *mutable_parameter_block_sizes() = {2 * num_joints, 2 * num_joints};
}

bool GpPriorCost::Evaluate(double const* const* parameters, double* residuals,
                           double** jacobians) const {
  const int n = num_joints_;
  // One column for position and one for velocity: W acts on the pair of each joint.
  const Eigen::Map<const Eigen::MatrixX2d> x0(parameters[0], n, 2), x1(parameters[1], n, 2);
  Eigen::Map<Eigen::MatrixX2d>(residuals, n, 2).noalias() =
      x0.lazyProduct(W_Phi_.transpose()) - x1.lazyProduct(W_.transpose());
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) SetKroneckerJacobian(W_Phi_, n, jacobians[0]);
  if (jacobians[1] != nullptr) SetKroneckerJacobian(-W_, n, jacobians[1]);
  return true;
}

}  // namespace sidestep::planner
