#include "sidestep/planner/gauss_newton_band.h"

#include <algorithm>
#include <cmath>

namespace sidestep::planner {

BlockTridiagonal::BlockTridiagonal(int num_blocks, int block_size)
    : num_blocks_(num_blocks),
      block_size_(block_size),
      band_(Eigen::MatrixXd::Zero(2 * block_size, num_blocks * block_size)) {}

void BlockTridiagonal::AddPair(int k, const Eigen::MatrixXd& H) {
  const int last = k + 1 < num_blocks_ ? 2 * block_size_ : block_size_;
  for (int c = 0; c < last; ++c) {
    band_.col(k * block_size_ + c).head(last - c) += H.col(c).segment(c, last - c);
  }
}

void BlockTridiagonal::AddToDiagonal(int k, double value) {
  band_.row(0).segment(k * block_size_, block_size_).array() += value;
}

bool BlockTridiagonal::Solve(Eigen::VectorXd& x) {
  const int size = num_blocks_ * block_size_;
  // How many rows column c has below its diagonal.
  const auto below = [&](int c) {
    const int last_block = std::min(c / block_size_ + 1, num_blocks_ - 1);
    return (last_block + 1) * block_size_ - 1 - c;
  };

  const Eigen::Index stride = band_.rows();
  for (int c = 0; c < size; ++c) {
    double* const column = band_.data() + c * stride;
    if (!(column[0] > 0)) return false;
    const double pivot = std::sqrt(column[0]);
    column[0] = pivot;
    const int n = below(c);
    for (int i = 1; i <= n; ++i) column[i] /= pivot;
    for (int j = 1; j <= n; ++j) {
      const double factor = column[j];
      double* const target = column + j * stride;  // its row 0 is our row j
      for (int i = 0; i <= n - j; ++i) target[i] -= factor * column[i + j];
    }
    x(c) /= pivot;
    for (int i = 1; i <= n; ++i) x(c + i) -= x(c) * column[i];
  }
  for (int c = size - 1; c >= 0; --c) {
    const double* const column = band_.data() + c * stride;
    double sum = x(c);
    for (int i = 1; i <= below(c); ++i) sum -= column[i] * x(c + i);
    x(c) = sum / column[0];
  }
  return true;
}

}  // namespace sidestep::planner
