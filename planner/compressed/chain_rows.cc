#include "sidestep/planner/compressed/chain_rows.h"

#include <algorithm>
#include <cmath>

#include "sidestep/planner/objective/chain_kernels.h"

namespace sidestep::planner {

bool ChainRows::Set(const ChainQuadratic& quadratic) {
  block_size_ = quadratic.block_size();
  stride_ = quadratic.stride();
  const int K = quadratic.num_blocks();
  const std::size_t size = quadratic.vector_size();
  undamped_.assign(size, 0.0);
  factor_.resize(static_cast<std::size_t>(K) * quadratic.panel_size());
  scale_.resize(size);
  // The last block passes zeros on to one more.
  residual_.assign(size + static_cast<std::size_t>(stride_), 0.0);
  std::copy_n(quadratic.gradient(0), size, residual_.begin());
  // H = C diag(1 / pivot) C^T: what makes R^T of C are the roots.
  if (!chain_kernels::Factor({K, block_size_, stride_}, quadratic.panel(0), undamped_.data(),
                             factor_.data(), scale_.data(), residual_.data())) {
    return false;
  }
  double square = 0;
  for (int k = 0; k < K; ++k) {
    for (int i = 0; i < block_size_; ++i) {
      const std::size_t at = quadratic.Place(k) + static_cast<std::size_t>(i);
      scale_[at] = std::sqrt(scale_[at]);
      residual_[at] *= scale_[at];
      square += residual_[at] * residual_[at];
    }
  }
  gain_ = 0.5 * square;
  rest_ = std::max(0.0, quadratic.cost.total() - gain_);
  return std::isfinite(gain_) && std::isfinite(rest_);
}

void ChainRows::CopyRow(int k, int i, double* own, double* next) const {
  const auto block = static_cast<std::size_t>(k), row = static_cast<std::size_t>(i),
             size = static_cast<std::size_t>(block_size_),
             stride = static_cast<std::size_t>(stride_);
  const double scale = scale_[block * stride + row];
  const double* const column = &factor_[(block * size + row) * 2 * stride];
  std::fill_n(own, i, 0.0);
  for (std::size_t j = row; j < size; ++j) own[j] = scale * column[j];
  if (next == nullptr) return;
  for (std::size_t j = 0; j < size; ++j) next[j] = scale * column[stride + j];
}

double ChainRows::residual(int k, int i) const {
  return residual_[static_cast<std::size_t>(k) * static_cast<std::size_t>(stride_) +
                   static_cast<std::size_t>(i)];
}

}  // namespace sidestep::planner
