#include "sidestep/planner/compressed/compressed_problem.h"

#include <algorithm>
#include <cmath>

#include "sidestep/planner/costs/state_jacobian.h"
#include "sidestep/planner/costs/state_prior_cost.h"

namespace sidestep::planner {

void CompressNormal(Eigen::Ref<Eigen::MatrixXd> normal) {
  constexpr double kDependent = 1e-11;  // share of a column's square that is rounding
  const Eigen::Index size = normal.rows();
  const Eigen::VectorXd squares = normal.diagonal();
  for (Eigen::Index j = 0; j < size; ++j) {
    auto below = normal.col(j).tail(size - j - 1);
    if (!(normal(j, j) > kDependent * squares(j))) {
      normal(j, j) = 0;
      below.setZero();
      continue;
    }
    normal(j, j) = std::sqrt(normal(j, j));
    below /= normal(j, j);
    for (Eigen::Index k = j + 1; k < size; ++k) {
      normal.col(k).tail(size - k) -= normal(k, j) * normal.col(j).tail(size - k);
    }
  }
  for (Eigen::Index j = 0; j < size; ++j) {
    for (Eigen::Index k = j + 1; k < size; ++k) {
      normal(j, k) = normal(k, j);
      normal(k, j) = 0;
    }
  }
}

// Step k of the objective, in two states; of the first state, in that alone.
class CompressedProblem::StepCost final : public ceres::CostFunction {
 public:
  StepCost(CompressedProblem& owner, int k, int num_states)
      : owner_(owner),
        k_(k),
        num_states_(num_states),
        quadratic_(owner.objective_.num_joints(), num_states) {
    const int block = 2 * owner.objective_.num_joints();
    set_num_residuals(num_states * block + 1);
    mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(num_states), block);
    normal_.resize(num_residuals(), num_residuals());
  }

  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    // What the callback has looked at are these parameters.
    quadratic_.SetZero();
    owner_.objective_.AddStep(owner_.states_, k_, num_states_ - 1, quadratic_);
    const double square = 2 * quadratic_.cost.total();
    Eigen::Map<Eigen::VectorXd> r(residuals, num_residuals());
    if (jacobians == nullptr) {
      r.setZero();
      r(0) = std::sqrt(square);
      return true;
    }
    const Eigen::Index last = num_residuals() - 1;
    normal_.topLeftCorner(last, last) = quadratic_.DenseHessian();
    normal_.row(last).head(last) = quadratic_.DenseGradient().transpose();
    normal_(last, last) = square;
    CompressNormal(normal_);
    r = normal_.col(last);
    const Eigen::Index width = last / num_states_;
    for (int state = 0; state < num_states_; ++state) {
      if (jacobians[state] == nullptr) continue;
      Eigen::Map<RowMajorMatrix>(jacobians[state], num_residuals(), width) =
          normal_.middleCols(state * width, width);
    }
    return true;
  }

 private:
  CompressedProblem& owner_;
  int k_, num_states_;
  mutable ChainQuadratic quadratic_;
  mutable Eigen::MatrixXd normal_;
};

CompressedProblem::CompressedProblem(TrajectoryObjective& objective, const Eigen::MatrixXd& states)
    : objective_(objective), states_(states) {
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
  for (int k = first; k < objective.num_states(); ++k) {
    costs_.push_back(std::make_unique<StepCost>(*this, k, k == 0 ? 1 : 2));
    std::vector<double*> blocks;
    if (k > 0) blocks.push_back(states_.col(k - 1).data());
    blocks.push_back(states_.col(k).data());
    problem_->AddResidualBlock(costs_.back().get(), nullptr, blocks);
  }
  for (const TrajectoryObjective::Prior& prior : objective.priors()) {
    const Eigen::Index n = size / 2;
    costs_.push_back(
        std::make_unique<StatePriorCost>(prior.x.head(n), prior.x.tail(n), prior.sigma));
    problem_->AddResidualBlock(costs_.back().get(), nullptr, states_.col(prior.state).data());
  }
}

void CompressedProblem::PrepareForEvaluation(bool, bool new_evaluation_point) {
  if (new_evaluation_point) objective_.Look(states_);
}

}  // namespace sidestep::planner
