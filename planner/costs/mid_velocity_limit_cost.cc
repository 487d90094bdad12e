#include "sidestep/planner/costs/mid_velocity_limit_cost.h"

#include <cmath>

#include "sidestep/planner/costs/state_jacobian.h"

namespace sidestep::planner {

MidVelocityLimitCost::MidVelocityLimitCost(double dt_s, const Eigen::VectorXd& v_max,
                                           const Eigen::VectorXd& weight)
    : dt_s_(dt_s), v_max_(v_max), weight_(weight) {
  const int n = static_cast<int>(v_max.size());
  set_num_residuals(n);
  *mutable_parameter_block_sizes() = {2 * n, 2 * n};
}

bool MidVelocityLimitCost::Evaluate(double const* const* parameters, double* residuals,
                                    double** jacobians) const {
  const Eigen::Index n = v_max_.size();
  const Eigen::Map<const Eigen::MatrixX2d> x0(parameters[0], n, 2), x1(parameters[1], n, 2);
  const double position = 1.5 / dt_s_, velocity = -0.25;
  const Eigen::VectorXd v = position * (x1 - x0).col(0) + velocity * (x0 + x1).col(1);
  Eigen::VectorXd slope(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double excess = std::abs(v(i)) - v_max_(i);
    residuals[i] = excess > 0 ? weight_(i) * excess : 0;
    slope(i) = excess > 0 ? std::copysign(weight_(i), v(i)) : 0;
  }
  if (jacobians == nullptr) return true;
  for (const int block : {0, 1}) {
    if (jacobians[block] == nullptr) continue;
    Eigen::Map<RowMajorMatrix> J(jacobians[block], n, 2 * n);
    J.setZero();
    J.leftCols(n).diagonal() = (block == 0 ? -position : position) * slope;
    J.rightCols(n).diagonal() = velocity * slope;
  }
  return true;
}

}  // namespace sidestep::planner
