#pragma once

#include <Eigen/Core>

namespace sidestep::planner {

/// A symmetric positive definite matrix that is block tridiagonal, K blocks of D x D on its
/// diagonal: the Hessian of a chain of states that know only their neighbours. Solved by Cholesky
/// within the band, in K D (2 D)^2 / 3 multiplications and no more memory than the band.
class BlockTridiagonal {
 public:
  BlockTridiagonal(int num_blocks, int block_size);

  void SetZero() { band_.setZero(); }

  /// Adds the lower triangle of the 2D x 2D matrix `H` of blocks k and k + 1; of the last block,
  /// k = K - 1, only the upper left quarter.
  void AddPair(int k, const Eigen::MatrixXd& H);
  void AddToDiagonal(int k, double value);

  /// Solves A x = b in place; A is replaced by its factor.
  /// @param x shape K D: b on entry, x on return.
  /// @return false, with `x` spoilt, unless A is positive definite.
  bool Solve(Eigen::VectorXd& x);

 private:
  int num_blocks_, block_size_;
  // Column c holds A(c + i, c) at row i. The rows of a block end with the block after it.
  Eigen::MatrixXd band_;
};

}  // namespace sidestep::planner
