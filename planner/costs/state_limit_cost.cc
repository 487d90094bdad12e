#include "sidestep/planner/costs/state_limit_cost.h"

#include <algorithm>

#include "sidestep/planner/costs/state_jacobian.h"

namespace sidestep::planner {

StateLimitCost::StateLimitCost(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                               const Eigen::VectorXd& weight)
    : lower_(lower), upper_(upper), weight_(weight) {
  const int size = static_cast<int>(lower.size());
  set_num_residuals(size);
  *mutable_parameter_block_sizes() = {size};
}

bool StateLimitCost::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  const Eigen::Index size = lower_.size();
  const Eigen::Map<const Eigen::VectorXd> x(parameters[0], size);
  for (Eigen::Index i = 0; i < size; ++i) {
    residuals[i] = weight_(i) * std::max({0.0, x(i) - upper_(i), lower_(i) - x(i)});
  }
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<RowMajorMatrix> J(jacobians[0], size, size);
    J.setZero();
    for (Eigen::Index i = 0; i < size; ++i) {
      if (x(i) > upper_(i)) J(i, i) = weight_(i);
      if (x(i) < lower_(i)) J(i, i) = -weight_(i);
    }
  }
  return true;
}

}  // namespace sidestep::planner
