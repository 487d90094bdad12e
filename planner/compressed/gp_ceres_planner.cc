#include "sidestep/planner/compressed/gp_ceres_planner.h"

#include <ceres/iteration_callback.h>

#include <optional>
#include <utility>

#include "sidestep/planner/ceres_solve.h"
#include "sidestep/planner/compressed/compressed_problem.h"
#include "sidestep/planner/objective/trajectory_objective.h"

namespace sidestep::planner {
namespace {

// Ends a solve, with the states as they are, where the quadratic around them promises no more than
// the tolerance: Ceres would take that step before it says so.
class NothingToGain final : public ceres::IterationCallback {
 public:
  /// `problem` is borrowed; its states are those of the latest iteration.
  NothingToGain(CompressedProblem& problem, double function_tolerance)
      : problem_(problem), function_tolerance_(function_tolerance) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    const bool is_new = iteration.iteration > 0 && iteration.step_is_successful;
    return is_new && problem_.IsBest(function_tolerance_) ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                          : ceres::SOLVER_CONTINUE;
  }

 private:
  CompressedProblem& problem_;
  double function_tolerance_;
};

class CompressedOptimizer final : public TrajectoryOptimizer {
 public:
  CompressedOptimizer(const robot::RobotModel& robot, const PlanRequest& request,
                      const PlannerSettings& settings, const GpProblemOptions& options,
                      std::shared_ptr<const obstacle_kernels::Arm> arm)
      : robot_(robot),
        request_(request),
        settings_(settings),
        options_(options),
        arm_(std::move(arm)) {}

  void Restart(const Trajectory& guess) override {
    if (!objective_ || objective_->t_s() != guess.t_s) {
      problem_.reset();
      objective_.emplace(arm_, request_, guess.t_s, options_);
    }
    objective_->Restart(guess);
    Eigen::MatrixXd states(2 * robot_.num_joints(), guess.num_states());
    states << guess.q, guess.v;
    problem_.emplace(*objective_, states);
  }
  void AddLimits(double stiffness) override {
    objective_->AddLimits(
        SoftLimitsOf(robot_, request_.q_start, request_.q_goal, settings_, stiffness));
    problem_->ForgetWhatWasSeen();
  }
  SolveOutcome Solve(int max_iterations, double function_tolerance) override {
    if (problem_->IsBest(function_tolerance)) return {0, true};
    NothingToGain nothing_to_gain(*problem_, function_tolerance);
    return SolveByLevenbergMarquardt(problem_->problem(), max_iterations, function_tolerance,
                                     request_.budget, &nothing_to_gain);
  }
  Trajectory GetTrajectory() const override {
    const int n = robot_.num_joints();
    return {objective_->t_s(), problem_->states().topRows(n), problem_->states().bottomRows(n)};
  }
  PlanCost ComputeCost() override { return problem_->Cost(); }

 private:
  const robot::RobotModel& robot_;
  const PlanRequest& request_;
  const PlannerSettings& settings_;
  const GpProblemOptions& options_;
  std::shared_ptr<const obstacle_kernels::Arm> arm_;
  std::optional<TrajectoryObjective> objective_;  // for the grid of the guesses
  std::optional<CompressedProblem> problem_;      // of that objective, from the present guess
};

}  // namespace

GpCeresPlanner::GpCeresPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
                               const GpSettings& gp)
    : SeededPlanner(robot, settings, gp),
      options_(ObjectiveOf(settings, gp)),
      arm_(TrajectoryObjective::MakeArm(robot, options_)) {}

std::unique_ptr<TrajectoryOptimizer> GpCeresPlanner::MakeOptimizer(
    const PlanRequest& request) const {
  return std::make_unique<CompressedOptimizer>(robot(), request, settings(), options_, arm_);
}

PlannerKind GpmpCeresKind() {
  return KindOf<GpCeresPlanner>(
      "the objective and the seeds of gpmp, by Ceres in fewer and smaller residual blocks",
      GpParameters());
}

}  // namespace sidestep::planner
