#pragma once

#include <array>
#include <cstddef>
#include <span>

/// The SIMD half of ChainQuadratic and of what fills it. A lane is a row, sums are in a fixed
/// order, nothing is contracted: every instruction set gives the same bits.
namespace sidestep::planner::chain_kernels {

/// See ChainQuadratic.
struct Chain {
  int num_blocks = 0, block_size = 0, stride = 0;
};

/// @param factor,inverse room for as many numbers as `panels` and a vector of the chain.
/// @param rhs one block longer than a vector of the chain, that one zero; the solution on return.
/// @return false unless the matrix is positive definite.
bool Solve(const Chain& chain, const double* panels, const double* damping, double* factor,
           double* inverse, double* rhs);

/// The first half of that: H + damping = C diag(inverse) C^T, where C is lower triangular and kept
/// as the panels are, with the pivots on its diagonal. `rhs` is left as y, C diag(inverse) y = rhs.
bool Factor(const Chain& chain, const double* panels, const double* damping, double* factor,
            double* inverse, double* rhs);

/// A quadratic in one configuration of an interval, whose position is the sum of `weights` times
/// (q, v, q, v) of the two states around it, or that of the second: what ObstacleQuadratics holds.
struct BetweenStates {
  const double* gradient = nullptr;
  const double* hessian = nullptr;
  std::array<double, 4> weights{};
  bool is_end = false;  ///< weights (0, 0, 1, 0)
};

/// Where the halves of an interval's quadratic go: the panels and gradients of the two states; null
/// for the near state if that is fixed.
struct IntervalTarget {
  double* near_panel = nullptr;
  double* near_gradient = nullptr;
  double* far_panel = nullptr;
  double* far_gradient = nullptr;
};

/// Adds to the states' quadratic what configurations between them say: for each pair of (q, v, q,
/// v), the product of their weights times the configuration's Hessian (a Kronecker product).
void AddBetween(int num_joints, int stride, std::span<const BetweenStates> between,
                const IntervalTarget& target);

}  // namespace sidestep::planner::chain_kernels
