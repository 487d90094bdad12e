#include "sidestep/planner/compressed/compressed_problem.h"

#include <algorithm>
#include <cmath>

namespace sidestep::planner {

// The rows of one state. What the callback has looked at are the parameters that Ceres asks about.
class CompressedProblem::Rows final : public ceres::CostFunction {
 public:
  Rows(const CompressedProblem& owner, int block, bool is_last)
      : owner_(owner), block_(block), is_last_(is_last), size_(owner.quadratic_.block_size()) {
    set_num_residuals(is_last ? size_ + 1 : size_);
    mutable_parameter_block_sizes()->assign(is_last ? 1 : 2, size_);
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    if (jacobians == nullptr) {
      // The length is all that counts, and the first row has all of it.
      std::fill_n(residuals, num_residuals(), 0.0);
      if (block_ == 0) residuals[0] = std::sqrt(2 * owner_.quadratic_.cost.total());
      return true;
    }
    if (!owner_.has_rows_) return false;
    for (int row = 0; row < size_; ++row) {
      residuals[row] = owner_.rows_.residual(block_, row);
      owner_.rows_.CopyRow(block_, row, jacobians[0] + row * size_,
                           is_last_ ? nullptr : jacobians[1] + row * size_);
    }
    if (is_last_) {
      residuals[size_] = std::sqrt(2 * owner_.rows_.rest());
      std::fill_n(jacobians[0] + size_ * size_, size_, 0.0);
    }
    return true;
  }

 private:
  const CompressedProblem& owner_;
  int block_;
  bool is_last_;
  int size_;
};

CompressedProblem::CompressedProblem(TrajectoryObjective& objective, const Eigen::MatrixXd& states)
    : objective_(objective), states_(states), quadratic_(objective.MakeQuadratic()) {}

const PlanCost& CompressedProblem::Cost() {
  Look();
  return quadratic_.cost;
}

bool CompressedProblem::IsBest(double tolerance) {
  Look();
  return HasRows() && rows_.gain() <= tolerance * quadratic_.cost.total();
}

ceres::Problem& CompressedProblem::problem() {
  if (problem_) return *problem_;
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;  // they hash every block, each time one is added
  options.evaluation_callback = this;
  problem_ = std::make_unique<ceres::Problem>(options);
  const int first = objective_.first_free(), size = quadratic_.block_size(),
            last = quadratic_.num_blocks() - 1;
  for (int k = 0; k <= last; ++k) {
    problem_->AddParameterBlock(states_.col(first + k).data(), size);
  }
  for (int k = 0; k <= last; ++k) {
    costs_.push_back(std::make_unique<Rows>(*this, k, k == last));
    std::vector<double*> blocks = {states_.col(first + k).data()};
    if (k < last) blocks.push_back(states_.col(first + k + 1).data());
    problem_->AddResidualBlock(costs_.back().get(), nullptr, blocks);
  }
  return *problem_;
}

void CompressedProblem::PrepareForEvaluation(bool evaluate_jacobians, bool) {
  Look();
  if (evaluate_jacobians) HasRows();
}

void CompressedProblem::Look() {
  if (is_seen_ && seen_at_ == states_) return;
  objective_.Evaluate(states_, quadratic_);
  seen_at_ = states_;
  is_seen_ = true;
  is_factored_ = false;
}

bool CompressedProblem::HasRows() {
  if (!is_factored_) has_rows_ = rows_.Set(quadratic_);
  is_factored_ = true;
  return has_rows_;
}

}  // namespace sidestep::planner
