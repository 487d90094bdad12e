#pragma once

#include <cstddef>

#include "sidestep/planner/objective/chain_quadratic.h"
#include "sidestep/sdf/aligned_vector.h"

namespace sidestep::planner {

/// A chain's quadratic as a least-squares problem of as few rows as can be: cost + g^T dx +
/// dx^T H dx / 2 = |R dx + r|^2 / 2 + rest, with the upper triangular R of R^T R = H and
/// R^T r = g. Of each block there are as many rows as it has unknowns; they are zero but in it and
/// in the next block. Keeps its memory from one quadratic to the next.
class ChainRows {
 public:
  /// @return false, and nothing else can be asked, unless H is positive definite.
  bool Set(const ChainQuadratic& quadratic);

  /// Row i of block k: its part in the block and in the next one, 2n numbers each. There must be a
  /// next one unless `next` is null.
  void CopyRow(int k, int i, double* own, double* next) const;
  double residual(int k, int i) const;

  /// By how much the best of all steps lowers the cost, |r|^2 / 2, and what is left of it then.
  double gain() const { return gain_; }
  double rest() const { return rest_; }

 private:
  int block_size_ = 0, stride_ = 0;
  sdf::AlignedVector<double> undamped_, factor_, scale_, residual_;
  double gain_ = 0, rest_ = 0;
};

}  // namespace sidestep::planner
