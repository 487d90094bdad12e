#include "sidestep/planner/compressed/compressed_problem.h"

#include <algorithm>
#include <cmath>

#include "sidestep/planner/costs/state_prior_cost.h"
#include "sidestep/planner/objective/chain_kernels.h"

namespace sidestep::planner {

// Some rows of a step, in its second state or in both. What the callback has looked at are the
// parameters that Ceres asks about.
class CompressedProblem::Rows final : public ceres::CostFunction {
 public:
  Rows(const CompressedProblem& owner, const Step& step, int begin, int end, bool in_both)
      : owner_(owner), step_(step), begin_(begin), size_(2 * owner.objective_.num_joints()) {
    set_num_residuals(end - begin);
    mutable_parameter_block_sizes()->assign(in_both ? 2 : 1, size_);
    first_column_ = in_both ? 0 : size_;
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    if (jacobians == nullptr) {
      // The length is all that counts, and the first rows have all of it.
      std::fill_n(residuals, num_residuals(), 0.0);
      if (begin_ == 0) residuals[0] = std::sqrt(2 * step_.cost);
      return true;
    }
    const int num_blocks = static_cast<int>(parameter_block_sizes().size());
    for (int row = 0; row < num_residuals(); ++row) {
      const double* const from = &step_.rows[static_cast<std::size_t>(begin_ + row) *
                                             static_cast<std::size_t>(owner_.height_)];
      residuals[row] = from[2 * size_];
      for (int block = 0; block < num_blocks; ++block) {
        if (jacobians[block] == nullptr) continue;
        std::copy_n(from + first_column_ + block * size_, size_, jacobians[block] + row * size_);
      }
    }
    return true;
  }

 private:
  const CompressedProblem& owner_;
  const Step& step_;
  int begin_, size_, first_column_;
};

CompressedProblem::CompressedProblem(TrajectoryObjective& objective, const Eigen::MatrixXd& states)
    : objective_(objective),
      states_(states),
      height_((4 * objective.num_joints() + 8) / 8 * 8),
      quadratic_(objective.num_joints(), 2),
      steps_(static_cast<std::size_t>(objective.num_states() - objective.first_free())) {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;  // they hash every block, each time one is added
  options.evaluation_callback = this;
  problem_ = std::make_unique<ceres::Problem>(options);
  const int first = objective.first_free(), size = 2 * objective.num_joints();
  for (int k = std::max(0, first - 1); k < objective.num_states(); ++k) {
    problem_->AddParameterBlock(states_.col(k).data(), size);
    if (k < first) problem_->SetParameterBlockConstant(states_.col(k).data());
  }
  const auto add = [&](std::unique_ptr<ceres::CostFunction> cost,
                       const std::vector<double*>& blocks) {
    costs_.push_back(std::move(cost));
    problem_->AddResidualBlock(costs_.back().get(), nullptr, blocks);
  };
  for (int k = first; k < objective.num_states(); ++k) {
    Step& step = steps_[static_cast<std::size_t>(k - first)];
    step.rows.assign(static_cast<std::size_t>(2 * size + 1) * static_cast<std::size_t>(height_),
                     0.0);
    double* const state = states_.col(k).data();
    if (k > 0) {
      add(std::make_unique<Rows>(*this, step, 0, size, true), {states_.col(k - 1).data(), state});
      add(std::make_unique<Rows>(*this, step, size, 2 * size + 1, false), {state});
    } else {
      add(std::make_unique<Rows>(*this, step, 0, 2 * size + 1, false), {state});
    }
  }
  const int n = objective.num_joints();
  for (const TrajectoryObjective::Prior& prior : objective.priors()) {
    add(std::make_unique<StatePriorCost>(prior.x.head(n), prior.x.tail(n), prior.sigma),
        {states_.col(prior.state).data()});
  }
}

void CompressedProblem::PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) {
  if (new_evaluation_point) objective_.Look(states_);
  for (std::size_t free = 0; free < steps_.size(); ++free) {
    Step& step = steps_[free];
    quadratic_.SetZero();
    objective_.AddStep(states_, objective_.first_free() + static_cast<int>(free), 1, quadratic_);
    step.cost = quadratic_.cost.total();
    if (!evaluate_jacobians) continue;
    // The lower triangle of (J, r)^T (J, r), column by column.
    const int size = quadratic_.block_size(), stride = quadratic_.stride();
    double* column = step.rows.data();
    for (int block = 0; block < 2; ++block) {
      for (int j = 0; j < size; ++j, column += height_) {
        const double* const from = quadratic_.panel(block) + j * 2 * stride;
        std::copy_n(from, size, column + block * size);
        if (block == 0) std::copy_n(from + stride, size, column + size);
        column[2 * size] = quadratic_.gradient(block)[j];
        std::fill(column + 2 * size + 1, column + height_, 0.0);
      }
    }
    std::fill_n(column, height_, 0.0);
    column[2 * size] = 2 * step.cost;
    chain_kernels::FactorSemidefinite(2 * size + 1, height_, step.rows.data());
  }
}

}  // namespace sidestep::planner
