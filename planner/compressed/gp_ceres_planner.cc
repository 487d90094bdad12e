#include "sidestep/planner/compressed/gp_ceres_planner.h"

#include <ceres/iteration_callback.h>

#include <optional>

#include "sidestep/planner/ceres_solve.h"
#include "sidestep/planner/compressed/compressed_problem.h"
#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/objective/trajectory_objective.h"

namespace sidestep::planner {
namespace {

// Ends a solve, with the states as they are, once it is known that no step could gain more than the
// tolerance: Ceres would look for the best one before it says so.
class NothingToGain final : public ceres::IterationCallback {
 public:
  /// Borrows all but the number. `states` are those of the latest iteration.
  NothingToGain(TrajectoryObjective& objective, ChainQuadratic& quadratic,
                const Eigen::MatrixXd& states, double function_tolerance)
      : objective_(objective),
        quadratic_(quadratic),
        states_(states),
        function_tolerance_(function_tolerance) {}

  bool IsTrue() const {
    objective_.Evaluate(states_, quadratic_);
    return objective_.MostDecrease(quadratic_) <= function_tolerance_ * quadratic_.cost.total();
  }
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    const bool is_new = iteration.iteration > 0 && iteration.step_is_successful;
    return is_new && IsTrue() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  TrajectoryObjective& objective_;
  ChainQuadratic& quadratic_;
  const Eigen::MatrixXd& states_;
  double function_tolerance_;
};

class CompressedOptimizer final : public TrajectoryOptimizer {
 public:
  CompressedOptimizer(const robot::RobotModel& robot, const PlanRequest& request,
                      const PlannerSettings& settings, const GpSettings& gp)
      : robot_(robot), request_(request), settings_(settings), gp_(gp) {}

  void Restart(const Trajectory& guess) override {
    if (!objective_ || objective_->t_s() != guess.t_s) {
      objective_.emplace(robot_, request_, guess.t_s, ObjectiveOf(settings_, gp_));
      quadratic_.emplace(objective_->MakeQuadratic());
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
    if (NothingToGain(*objective_, *quadratic_, states(), function_tolerance).IsTrue()) {
      return {0, true};
    }
    if (!problem_) problem_ = std::make_unique<CompressedProblem>(*objective_, states_);
    NothingToGain nothing_to_gain(*objective_, *quadratic_, states(), function_tolerance);
    return SolveByLevenbergMarquardt(problem_->problem(), max_iterations, function_tolerance,
                                     request_.budget, &nothing_to_gain);
  }
  Trajectory GetTrajectory() const override {
    const int n = robot_.num_joints();
    return {objective_->t_s(), states().topRows(n), states().bottomRows(n)};
  }
  PlanCost ComputeCost() override {
    objective_->Evaluate(states(), *quadratic_);
    return quadratic_->cost;
  }

 private:
  // 2n x K: where the problem is, if there had to be one.
  const Eigen::MatrixXd& states() const { return problem_ ? problem_->states() : states_; }

  const robot::RobotModel& robot_;
  const PlanRequest& request_;
  const PlannerSettings& settings_;
  const GpSettings& gp_;
  std::optional<TrajectoryObjective> objective_;  // for the grid of the guesses
  std::optional<ChainQuadratic> quadratic_;       // of that objective
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
