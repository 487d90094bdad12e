#include "sidestep/planner/fast/gp_fast_planner.h"

#include <optional>
#include <utility>

#include "sidestep/planner/fast/levenberg_marquardt.h"
#include "sidestep/planner/objective/trajectory_objective.h"

namespace sidestep::planner {
namespace {

class FastOptimizer final : public TrajectoryOptimizer {
 public:
  FastOptimizer(const robot::RobotModel& robot, const PlanRequest& request,
                const PlannerSettings& settings, const GpProblemOptions& options,
                std::shared_ptr<const obstacle_kernels::Arm> arm)
      : robot_(robot),
        request_(request),
        settings_(settings),
        options_(options),
        arm_(std::move(arm)) {}

  void Restart(const Trajectory& guess) override {
    if (!objective_ || objective_->t_s() != guess.t_s) {
      objective_.emplace(arm_, request_, guess.t_s, options_);
      solver_.emplace(*objective_);
    }
    objective_->Restart(guess);
    states_.resize(2 * robot_.num_joints(), guess.num_states());
    states_ << guess.q, guess.v;
  }
  void AddLimits(double stiffness) override {
    objective_->AddLimits(
        SoftLimitsOf(robot_, request_.q_start, request_.q_goal, settings_, stiffness));
  }
  SolveOutcome Solve(int max_iterations, double function_tolerance) override {
    return solver_->Solve(max_iterations, function_tolerance, states_, request_.budget);
  }
  Trajectory GetTrajectory() const override {
    const int n = robot_.num_joints();
    return {objective_->t_s(), states_.topRows(n), states_.bottomRows(n)};
  }
  PlanCost ComputeCost() override { return solver_->cost(); }

 private:
  const robot::RobotModel& robot_;
  const PlanRequest& request_;
  const PlannerSettings& settings_;
  const GpProblemOptions& options_;
  std::shared_ptr<const obstacle_kernels::Arm> arm_;
  std::optional<TrajectoryObjective> objective_;  // for the grid of the guesses
  std::optional<LevenbergMarquardt> solver_;      // of that objective
  Eigen::MatrixXd states_;                        // 2n x K
};

}  // namespace

GpFastPlanner::GpFastPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
                             const GpSettings& gp)
    : SeededPlanner(robot, settings, gp),
      options_(ObjectiveOf(settings, gp)),
      arm_(TrajectoryObjective::MakeArm(robot, options_)) {}

std::unique_ptr<TrajectoryOptimizer> GpFastPlanner::MakeOptimizer(
    const PlanRequest& request) const {
  return std::make_unique<FastOptimizer>(robot(), request, settings(), options_, arm_);
}

PlannerKind GpmpFastKind() {
  return KindOf<GpFastPlanner>(
      "the objective and the seeds of gpmp, by a solver of our own that is many times faster",
      GpParameters());
}

}  // namespace sidestep::planner
