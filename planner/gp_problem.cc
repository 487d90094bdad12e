#include "sidestep/planner/gp_problem.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "sidestep/planner/costs/acceleration_limit_cost.h"
#include "sidestep/planner/costs/gp_prior_cost.h"
#include "sidestep/planner/costs/interpolated_obstacle_cost.h"
#include "sidestep/planner/costs/mid_velocity_limit_cost.h"
#include "sidestep/planner/costs/obstacle_cost.h"
#include "sidestep/planner/costs/state_limit_cost.h"
#include "sidestep/planner/costs/state_prior_cost.h"
#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {
namespace {

// This class owns the cost functions, so that intervals may share one.
ceres::Problem::Options ProblemOptions() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;  // they hash every block, each time one is added
  return options;
}

}  // namespace

GpProblem::GpProblem(const robot::RobotModel& robot, const PlanRequest& request,
                     const Trajectory& initial, const GpProblemOptions& options)
    : robot_(robot),
      t_s_(initial.t_s),
      step_s_(request.step_s),
      first_free_(options.sigma_fixed ? 0 : request.num_fixed),
      states_(2 * robot.num_joints(), request.num_states),
      hinge_(robot, *request.field, options.epsilon_m, options.sigma_obs, options.self_epsilon_m,
             options.condensed),
      problem_(ProblemOptions()) {
  const int n = robot.num_joints(), K = request.num_states;
  states_ << initial.q, initial.v;
  // Constants further back than the first free state's neighbour decide nothing.
  for (int k = std::max(0, first_free_ - 1); k < K; ++k) {
    problem_.AddParameterBlock(states_.col(k).data(), 2 * n);
    if (k < first_free_) problem_.SetParameterBlockConstant(states_.col(k).data());
  }

  if (options.sigma_fixed) {
    AddTerm(
        std::make_unique<StatePriorCost>(request.q_start, request.v_start, *options.sigma_fixed), 0,
        &PlanCost::goal);
    for (int k = 1; k < request.num_fixed; ++k) {
      AddTerm(std::make_unique<StatePriorCost>(initial.q.col(k), initial.v.col(k),
                                               *options.sigma_fixed),
              k, &PlanCost::goal);
    }
  }
  AddTerm(std::make_unique<StatePriorCost>(request.q_goal, Eigen::VectorXd::Zero(n),
                                           options.sigma_goal),
          K - 1, &PlanCost::goal);

  costs_.push_back(std::make_unique<GpPriorCost>(n, step_s_, options.qc));
  const ceres::CostFunction* const gp_prior = costs_.back().get();
  for (int k = first_free_; k < K; ++k) {
    const EpisodeTime t = request.start + HorizonOffset(t_s_(k));
    AddTerm(std::make_unique<ObstacleCost>(hinge_, t), k, &PlanCost::obstacle);
    if (k == 0) continue;
    AddTerm(gp_prior, k - 1, &PlanCost::gp);
    for (int j = 1; j <= options.num_interpolated; ++j) {
      const double tau_s = step_s_ * j / (options.num_interpolated + 1);
      const EpisodeTime t_between = request.start + HorizonOffset(t_s_(k - 1) + tau_s);
      AddTerm(std::make_unique<InterpolatedObstacleCost>(hinge_, InterpolateGp(step_s_, tau_s),
                                                         t_between),
              k - 1, &PlanCost::obstacle);
    }
  }
}

void GpProblem::AddLimits(const SoftLimits& limits) {
  const int n = robot_.num_joints(), K = static_cast<int>(t_s_.size());
  const LimitWeights& weights = limits.weights;
  Eigen::VectorXd weight(2 * n);
  weight << Eigen::VectorXd::Constant(n, weights.position),
      Eigen::VectorXd::Constant(n, weights.velocity);

  if (weights.position > 0 || weights.velocity > 0) {
    costs_.push_back(std::make_unique<StateLimitCost>(limits.lower, limits.upper, weight));
    const ceres::CostFunction* const cost = costs_.back().get();
    for (int k = first_free_; k < K; ++k) AddTerm(cost, k, &PlanCost::limits);
  }
  const auto add_to_intervals = [&](std::unique_ptr<ceres::CostFunction> cost) {
    costs_.push_back(std::move(cost));
    for (int k = std::max(0, first_free_ - 1); k + 1 < K; ++k) {
      AddTerm(costs_.back().get(), k, &PlanCost::limits);
    }
  };
  if (weights.velocity > 0) {
    add_to_intervals(
        std::make_unique<MidVelocityLimitCost>(step_s_, limits.upper.tail(n), weight.tail(n)));
  }
  if (weights.acceleration > 0) {
    add_to_intervals(std::make_unique<AccelerationLimitCost>(
        step_s_, limits.a_max, Eigen::VectorXd::Constant(n, weights.acceleration)));
  }
}

Trajectory GpProblem::GetTrajectory() const {
  const int n = robot_.num_joints();
  return {t_s_, states_.topRows(n), states_.bottomRows(n)};
}

PlanCost GpProblem::ComputeCost() const {
  PlanCost total;
  Eigen::VectorXd residuals;
  for (const Term& term : terms_) {
    residuals.resize(term.cost->num_residuals());
    const int next = std::min<int>(term.state + 1, static_cast<int>(states_.cols()) - 1);
    const std::array<const double*, 2> blocks = {states_.col(term.state).data(),
                                                 states_.col(next).data()};
    term.cost->Evaluate(blocks.data(), residuals.data(), nullptr);
    total.*term.part += 0.5 * residuals.squaredNorm();
  }
  return total;
}

void GpProblem::AddTerm(std::unique_ptr<ceres::CostFunction> cost, int state,
                        double PlanCost::*part) {
  costs_.push_back(std::move(cost));
  AddTerm(costs_.back().get(), state, part);
}

void GpProblem::AddTerm(const ceres::CostFunction* cost, int state, double PlanCost::*part) {
  terms_.push_back({cost, state, part});
  std::vector<double*> blocks = {states_.col(state).data()};
  if (cost->parameter_block_sizes().size() == 2) blocks.push_back(states_.col(state + 1).data());
  // Ceres takes a pointer to non-const, though it only ever evaluates.
  problem_.AddResidualBlock(const_cast<ceres::CostFunction*>(cost), nullptr, blocks);
}

}  // namespace sidestep::planner
