#include "sidestep/planner/compressed/gp_ceres_planner.h"

#include <optional>

#include "sidestep/planner/ceres_solve.h"
#include "sidestep/planner/compressed/compressed_problem.h"
#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/objective/trajectory_objective.h"

namespace sidestep::planner {
namespace {

class CompressedOptimizer final : public TrajectoryOptimizer {
 public:
  CompressedOptimizer(const robot::RobotModel& robot, const PlanRequest& request,
                      const PlannerSettings& settings, const GpSettings& gp)
      : robot_(robot), request_(request), settings_(settings), gp_(gp) {}

  void Restart(const Trajectory& guess) override {
    if (!objective_ || objective_->t_s() != guess.t_s) {
      objective_.emplace(robot_, request_, guess.t_s, ObjectiveOf(settings_, gp_));
    }
    objective_->Restart(guess);
    Eigen::MatrixXd states(2 * robot_.num_joints(), guess.num_states());
    states << guess.q, guess.v;
    problem_ = std::make_unique<CompressedProblem>(*objective_, states);
  }
  void AddLimits(double stiffness) override {
    objective_->AddLimits(
        SoftLimitsOf(robot_, request_.q_start, request_.q_goal, settings_, stiffness));
  }
  SolveOutcome Solve(int max_iterations, double function_tolerance) override {
    return SolveByLevenbergMarquardt(problem_->problem(), max_iterations, function_tolerance,
                                     request_.budget);
  }
  Trajectory GetTrajectory() const override {
    const int n = robot_.num_joints();
    return {objective_->t_s(), problem_->states().topRows(n), problem_->states().bottomRows(n)};
  }
  PlanCost ComputeCost() override {
    ChainQuadratic quadratic = objective_->MakeQuadratic();
    objective_->Evaluate(problem_->states(), quadratic);
    return quadratic.cost;
  }

 private:
  const robot::RobotModel& robot_;
  const PlanRequest& request_;
  const PlannerSettings& settings_;
  const GpSettings& gp_;
  std::optional<TrajectoryObjective> objective_;  // for the grid of the guesses
  std::unique_ptr<CompressedProblem> problem_;    // of the present guess
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
