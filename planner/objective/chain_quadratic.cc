#include "sidestep/planner/objective/chain_quadratic.h"

#include <algorithm>

#include "sidestep/planner/objective/chain_kernels.h"
#include "sidestep/planner/objective/obstacle_objective.h"

namespace sidestep::planner {
namespace {

int RoundUpToVector(int size) { return (size + 7) / 8 * 8; }

}  // namespace

ChainQuadratic::ChainQuadratic(int num_joints, int num_blocks)
    : num_joints_(num_joints),
      num_blocks_(num_blocks),
      stride_(RoundUpToVector(num_joints + ObstacleQuadratics::PaddedRows(num_joints))),
      panels_(static_cast<std::size_t>(num_blocks) * panel_size()),
      gradient_(vector_size()) {}

void ChainQuadratic::SetZero() {
  std::fill(panels_.begin(), panels_.end(), 0.0);
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
  cost = {};
}

Eigen::MatrixXd ChainQuadratic::DenseHessian() const {
  const int D = block_size();
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(num_blocks_ * D, num_blocks_ * D);
  for (int k = 0; k < num_blocks_; ++k) {
    const Eigen::Map<const Eigen::MatrixXd> panel_k(panel(k), 2 * stride_, D);
    H.block(k * D, k * D, D, D) = panel_k.topRows(D);
    if (k + 1 < num_blocks_) H.block((k + 1) * D, k * D, D, D) = panel_k.middleRows(stride_, D);
  }
  return H.selfadjointView<Eigen::Lower>();
}

Eigen::VectorXd ChainQuadratic::DenseGradient() const {
  const int D = block_size();
  Eigen::VectorXd dense(num_blocks_ * D);
  for (int k = 0; k < num_blocks_; ++k) {
    dense.segment(k * D, D) = Eigen::Map<const Eigen::VectorXd>(gradient(k), D);
  }
  return dense;
}

bool ChainSolver::Solve(const ChainQuadratic& quadratic, const sdf::AlignedVector<double>& damping,
                        sdf::AlignedVector<double>& step) {
  const int K = quadratic.num_blocks();
  const std::size_t size = quadratic.vector_size();
  factor_.resize(static_cast<std::size_t>(K) * quadratic.panel_size());
  inverse_.resize(size);
  // The last block passes zeros on to one more.
  rhs_.resize(size + static_cast<std::size_t>(quadratic.stride()));
  for (std::size_t i = 0; i < size; ++i) rhs_[i] = -quadratic.gradient(0)[i];
  std::fill(rhs_.begin() + static_cast<std::ptrdiff_t>(size), rhs_.end(), 0.0);
  if (!chain_kernels::Solve({K, quadratic.block_size(), quadratic.stride()}, quadratic.panel(0),
                            damping.data(), factor_.data(), inverse_.data(), rhs_.data())) {
    return false;
  }
  step.assign(rhs_.begin(), rhs_.begin() + static_cast<std::ptrdiff_t>(size));
  return true;
}

}  // namespace sidestep::planner
