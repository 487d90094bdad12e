#include "sidestep/planner/compressed/gp_ceres_planner.h"

#include <ceres/iteration_callback.h>

#include <optional>

#include "sidestep/planner/ceres_solve.h"
#include "sidestep/planner/compressed/compressed_problem.h"
#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/objective/chain_quadratic.h"
#include "sidestep/planner/objective/trajectory_objective.h"
#include "sidestep/sdf/aligned_vector.h"

namespace sidestep::planner {
namespace {

// Ends a solve, with the states as they are, where the quadratic around them promises no more than
// the tolerance: Ceres would take that step before it says so.
class NothingToGain final : public ceres::IterationCallback {
 public:
  /// `objective` is borrowed.
  explicit NothingToGain(TrajectoryObjective& objective)
      : objective_(objective),
        quadratic_(objective.MakeQuadratic()),
        undamped_(quadratic_.vector_size(), 0.0) {}

  /// What is asked from now on; `states` is borrowed and holds those of the latest iteration.
  void Watch(const Eigen::MatrixXd& states, double function_tolerance) {
    states_ = &states;
    function_tolerance_ = function_tolerance;
  }
  bool IsTrue() {
    objective_.Evaluate(*states_, quadratic_);
    if (!solver_.Solve(quadratic_, undamped_, step_)) return false;
    double gain = 0;
    for (std::size_t i = 0; i < step_.size(); ++i)
      gain -= 0.5 * quadratic_.gradient(0)[i] * step_[i];
    return gain <= function_tolerance_ * quadratic_.cost.total();
  }
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    const bool is_new = iteration.iteration > 0 && iteration.step_is_successful;
    return is_new && IsTrue() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  TrajectoryObjective& objective_;
  ChainQuadratic quadratic_;
  ChainSolver solver_;
  sdf::AlignedVector<double> undamped_, step_;
  const Eigen::MatrixXd* states_ = nullptr;
  double function_tolerance_ = 0;
};

class CompressedOptimizer final : public TrajectoryOptimizer {
 public:
  CompressedOptimizer(const robot::RobotModel& robot, const PlanRequest& request,
                      const PlannerSettings& settings, const GpSettings& gp)
      : robot_(robot), request_(request), settings_(settings), gp_(gp) {}

  void Restart(const Trajectory& guess) override {
    if (!objective_ || objective_->t_s() != guess.t_s) {
      objective_.emplace(robot_, request_, guess.t_s, ObjectiveOf(settings_, gp_));
      nothing_to_gain_.emplace(*objective_);
    }
    objective_->Restart(guess);
    problem_.reset();
    states_.resize(2 * robot_.num_joints(), guess.num_states());
    states_ << guess.q, guess.v;
  }
  void AddLimits(double stiffness) override {
    objective_->AddLimits(
        SoftLimitsOf(robot_, request_.q_start, request_.q_goal, settings_, stiffness));
  }
  SolveOutcome Solve(int max_iterations, double function_tolerance) override {
    nothing_to_gain_->Watch(states(), function_tolerance);
    if (nothing_to_gain_->IsTrue()) return {0, true};
    if (!problem_) problem_ = std::make_unique<CompressedProblem>(*objective_, states_);
    nothing_to_gain_->Watch(states(), function_tolerance);
    return SolveByLevenbergMarquardt(problem_->problem(), max_iterations, function_tolerance,
                                     request_.budget, &*nothing_to_gain_);
  }
  Trajectory GetTrajectory() const override {
    const int n = robot_.num_joints();
    return {objective_->t_s(), states().topRows(n), states().bottomRows(n)};
  }
  PlanCost ComputeCost() override {
    ChainQuadratic quadratic = objective_->MakeQuadratic();
    objective_->Evaluate(states(), quadratic);
    return quadratic.cost;
  }

 private:
  // 2n x K: where the problem is, if there had to be one.
  const Eigen::MatrixXd& states() const { return problem_ ? problem_->states() : states_; }

  const robot::RobotModel& robot_;
  const PlanRequest& request_;
  const PlannerSettings& settings_;
  const GpSettings& gp_;
  std::optional<TrajectoryObjective> objective_;  // for the grid of the guesses
  std::optional<NothingToGain> nothing_to_gain_;  // of that objective
  Eigen::MatrixXd states_;                        // the present guess
  std::unique_ptr<CompressedProblem> problem_;    // of the present guess, once it is solved
};

}  // namespace

std::unique_ptr<TrajectoryOptimizer> GpCeresPlanner::MakeOptimizer(
    const PlanRequest& request) const {
  return std::make_unique<CompressedOptimizer>(robot(), request, settings(), gp());
}

PlannerKind GpmpCeresKind() {
  return KindOf<GpCeresPlanner>(
      "the objective and the seeds of gpmp, by Ceres in fewer and smaller residual blocks",
      GpParameters());
}

}  // namespace sidestep::planner
