#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/planner/objective/chain_quadratic.h"

namespace sidestep::planner {

/// A bound on what any step could gain, without solving for one. An objective's Hessian H is that
/// of the GP prior and the priors on states, S, and more that is positive semidefinite; so the
/// decrease g^T H^-1 g / 2 that its quadratic promises is at most g^T S^-1 g / 2. In S joints are
/// apart and alike, so that it is a chain of 2 x 2 blocks.
class SmoothnessBound {
 public:
  /// @param dt_s, qc of the GP prior. @param information of the prior on each block of the chain, 0
  /// where there is none. @param follows_fixed whether a fixed state comes before the first block.
  /// S must be positive definite.
  SmoothnessBound(double dt_s, double qc, const std::vector<double>& information,
                  bool follows_fixed);

  double MostDecrease(const ChainQuadratic& quadratic) const;

 private:
  // Of each block, S = L L^T: the lower triangle of L, its diagonal inverted, and the block below.
  struct Factor {
    double inverse_00, l_10, inverse_11;
    Eigen::Matrix2d below;
  };
  std::vector<Factor> factors_;
};

}  // namespace sidestep::planner
