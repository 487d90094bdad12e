#pragma once

#include <Eigen/Core>

namespace sidestep::planner {

/// Jacobians as Ceres wants them: row-major.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Fills the 2n x 2n `jacobian` of a map that treats every joint's (position, velocity) by the same
/// matrix A: the Kronecker product of A and I_n.
inline void SetKroneckerJacobian(const Eigen::Matrix2d& A, int n, double* jacobian) {
  Eigen::Map<RowMajorMatrix> J(jacobian, 2 * n, 2 * n);
  J.setZero();
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      J.block(row * n, column * n, n, n).diagonal().setConstant(A(row, column));
    }
  }
}

}  // namespace sidestep::planner
