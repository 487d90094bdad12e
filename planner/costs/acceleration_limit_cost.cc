#include "sidestep/planner/costs/acceleration_limit_cost.h"

#include <algorithm>
#include <cmath>

#include "sidestep/planner/costs/state_jacobian.h"

namespace sidestep::planner {

AccelerationLimitCost::AccelerationLimitCost(double dt_s, const Eigen::VectorXd& a_max,
                                             const Eigen::VectorXd& weight)
    : dt_s_(dt_s), a_max_(a_max), weight_(weight) {
  const int size = 2 * static_cast<int>(a_max.size());
  set_num_residuals(size);
  *mutable_parameter_block_sizes() = {size, size};
}

bool AccelerationLimitCost::Evaluate(double const* const* parameters, double* residuals,
                                     double** jacobians) const {
  const int n = static_cast<int>(a_max_.size());
  const double position = 6 / (dt_s_ * dt_s_), near_velocity = 4 / dt_s_, far_velocity = 2 / dt_s_;
  if (jacobians != nullptr) {
    for (int block = 0; block < 2; ++block) {
      if (jacobians[block] != nullptr) std::fill_n(jacobians[block], 4 * n * n, 0.0);
    }
  }
  const Eigen::Map<const Eigen::MatrixX2d> x0(parameters[0], n, 2), x1(parameters[1], n, 2);
  for (int end = 0; end < 2; ++end) {
    const double sign = end == 0 ? -1 : 1;
    const double v0_share = end == 0 ? near_velocity : far_velocity;
    const double v1_share = end == 0 ? far_velocity : near_velocity;
    for (int i = 0; i < n; ++i) {
      const double a =
          sign * (position * (x0(i, 0) - x1(i, 0)) + v0_share * x0(i, 1) + v1_share * x1(i, 1));
      const int row = end * n + i;
      const bool active = std::abs(a) > a_max_(i);
      residuals[row] = active ? weight_(i) * (std::abs(a) - a_max_(i)) : 0;
      if (!active || jacobians == nullptr) continue;
      const double slope = weight_(i) * sign * (a > 0 ? 1 : -1);
      if (jacobians[0] != nullptr) {
        jacobians[0][row * 2 * n + i] = slope * position;
        jacobians[0][row * 2 * n + n + i] = slope * v0_share;
      }
      if (jacobians[1] != nullptr) {
        jacobians[1][row * 2 * n + i] = -slope * position;
        jacobians[1][row * 2 * n + n + i] = slope * v1_share;
      }
    }
  }
  return true;
}

}  // namespace sidestep::planner
