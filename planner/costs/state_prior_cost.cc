#include "sidestep/planner/costs/state_prior_cost.h"

#include "sidestep/planner/costs/state_jacobian.h"

namespace sidestep::planner {

StatePriorCost::StatePriorCost(const Eigen::VectorXd& q_desired, const Eigen::VectorXd& v_desired,
                               double sigma)
    : x_desired_(q_desired.size() + v_desired.size()), sigma_(sigma) {
  x_desired_ << q_desired, v_desired;
  const int size = static_cast<int>(x_desired_.size());
  set_num_residuals(size);
  *mutable_parameter_block_sizes() = {size};
}

bool StatePriorCost::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  const Eigen::Index size = x_desired_.size();
  const Eigen::Map<const Eigen::VectorXd> x(parameters[0], size);
  Eigen::Map<Eigen::VectorXd>(residuals, size) = (x - x_desired_) / sigma_;
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<RowMajorMatrix> J(jacobians[0], size, size);
    J.setZero();
    J.diagonal().setConstant(1 / sigma_);
  }
  return true;
}

}  // namespace sidestep::planner
