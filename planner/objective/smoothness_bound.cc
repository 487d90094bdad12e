#include "sidestep/planner/objective/smoothness_bound.h"

#include <cmath>

#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {

SmoothnessBound::SmoothnessBound(double dt_s, double qc, const std::vector<double>& information,
                                 bool follows_fixed) {
  // Of an interval: Phi^T Q^-1 Phi at its begin, Q^-1 at its end, -Q^-1 Phi between them.
  const Eigen::Matrix2d Q_inverse = GpInformation(dt_s, qc), Phi = GpTransition(dt_s);
  Eigen::Matrix2d taken = Eigen::Matrix2d::Zero();  // off a block by the one before
  for (std::size_t k = 0; k < information.size(); ++k) {
    const bool is_last = k + 1 == information.size();
    Eigen::Matrix2d S = information[k] * Eigen::Matrix2d::Identity() - taken;
    if (k > 0 || follows_fixed) S += Q_inverse;
    if (!is_last) S += Phi.transpose() * Q_inverse * Phi;
    Factor& factor = factors_.emplace_back();
    factor.inverse_00 = 1 / std::sqrt(S(0, 0));
    factor.l_10 = S(1, 0) * factor.inverse_00;
    factor.inverse_11 = 1 / std::sqrt(S(1, 1) - factor.l_10 * factor.l_10);
    if (is_last) break;
    const Eigen::Matrix2d below = -Q_inverse * Phi;
    factor.below.col(0) = below.col(0) * factor.inverse_00;
    factor.below.col(1) = (below.col(1) - factor.l_10 * factor.below.col(0)) * factor.inverse_11;
    taken = factor.below * factor.below.transpose();
  }
}

double SmoothnessBound::MostDecrease(const ChainQuadratic& quadratic) const {
  const int n = quadratic.num_joints();
  double sum = 0;
  // y = L^-1 g, joint by joint; what of it the next block is rid of is carried on.
  Eigen::ArrayXd carried_q = Eigen::ArrayXd::Zero(n), carried_v = Eigen::ArrayXd::Zero(n);
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    const Factor& factor = factors_[k];
    const Eigen::Map<const Eigen::ArrayXd> g_q(quadratic.gradient(static_cast<int>(k)), n),
        g_v(quadratic.gradient(static_cast<int>(k)) + n, n);
    const bool is_last = k + 1 == factors_.size();
    for (int i = 0; i < n; ++i) {
      const double y_q = (g_q(i) - carried_q(i)) * factor.inverse_00;
      const double y_v = (g_v(i) - carried_v(i) - factor.l_10 * y_q) * factor.inverse_11;
      sum += y_q * y_q + y_v * y_v;
      if (is_last) continue;
      carried_q(i) = factor.below(0, 0) * y_q + factor.below(0, 1) * y_v;
      carried_v(i) = factor.below(1, 0) * y_q + factor.below(1, 1) * y_v;
    }
  }
  return 0.5 * sum;
}

}  // namespace sidestep::planner
