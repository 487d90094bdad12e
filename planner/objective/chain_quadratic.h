#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "sidestep/planner/planner.h"
#include "sidestep/sdf/aligned_vector.h"

namespace sidestep::planner {

/// A quadratic in the step of a chain of blocks (a trajectory's free states), each of which knows
/// only its neighbours: cost + gradient^T dx + dx^T H dx / 2. H is symmetric and block tridiagonal;
/// of each block on its diagonal the lower triangle counts.
///
/// Columns are padded with zeros, for those who work on them by vectors.
class ChainQuadratic {
 public:
  /// Blocks of 2n for n joints, whose numbers mean nothing before SetZero().
  ChainQuadratic(int num_joints, int num_blocks);

  void SetZero();

  int num_joints() const { return num_joints_; }
  int num_blocks() const { return num_blocks_; }
  int block_size() const { return 2 * num_joints_; }
  /// Numbers from one block of a chain's vector to the next: at least n + PaddedRows(n).
  int stride() const { return stride_; }
  std::size_t vector_size() const { return Place(num_blocks_); }

  PlanCost cost;
  double* gradient(int k) { return &gradient_[Place(k)]; }
  const double* gradient(int k) const { return &gradient_[Place(k)]; }
  /// Block column k: 2n columns, each of 2 stride() numbers, first those of block k, then those of
  /// block k + 1.
  double* panel(int k) { return &panels_[static_cast<std::size_t>(k) * panel_size()]; }
  const double* panel(int k) const { return &panels_[static_cast<std::size_t>(k) * panel_size()]; }
  std::size_t panel_size() const { return Place(2) * static_cast<std::size_t>(block_size()); }
  /// Of block k in a chain's vector.
  std::size_t Place(int k) const {
    return static_cast<std::size_t>(k) * static_cast<std::size_t>(stride_);
  }

  /// The diagonal entry i of block k.
  double diagonal(int k, int i) const { return panel(k)[i * 2 * stride_ + i]; }

  /// For tests and for solvers that do not care how it is kept.
  Eigen::MatrixXd DenseHessian() const;
  Eigen::VectorXd DenseGradient() const;

 private:
  int num_joints_, num_blocks_, stride_;
  sdf::AlignedVector<double> panels_, gradient_;
};

/// Solves (H + damping) dx = -gradient by Cholesky, block by block. Keeps its memory from one call
/// to the next.
class ChainSolver {
 public:
  /// @param damping what is added to the diagonal, vector_size() numbers, >= 0.
  /// @param step receives dx, in the same places.
  /// @return false, with `step` spoilt, unless H + damping is positive definite.
  bool Solve(const ChainQuadratic& quadratic, const sdf::AlignedVector<double>& damping,
             sdf::AlignedVector<double>& step);

 private:
  sdf::AlignedVector<double> factor_, inverse_, rhs_;
};

}  // namespace sidestep::planner
