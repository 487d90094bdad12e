#include "sidestep/planner/gp_planner.h"

#include <optional>

#include "sidestep/planner/ceres_solve.h"
#include "sidestep/planner/gp_problem.h"

namespace sidestep::planner {
namespace {

class CeresOptimizer final : public TrajectoryOptimizer {
 public:
  CeresOptimizer(const robot::RobotModel& robot, const PlanRequest& request,
                 const PlannerSettings& settings, const GpSettings& gp, bool condensed)
      : robot_(robot), request_(request), settings_(settings), options_(ObjectiveOf(settings, gp)) {
    options_.condensed = condensed;
  }

  void Restart(const Trajectory& guess) override {
    problem_.reset();
    problem_.emplace(robot_, request_, guess, options_);
  }
  void AddLimits(double stiffness) override {
    problem_->AddLimits(
        SoftLimitsOf(robot_, request_.q_start, request_.q_goal, settings_, stiffness));
  }
  SolveOutcome Solve(int max_iterations, double function_tolerance) override {
    return SolveByLevenbergMarquardt(problem_->problem(), max_iterations, function_tolerance,
                                     request_.budget);
  }
  Trajectory GetTrajectory() const override { return problem_->GetTrajectory(); }
  PlanCost ComputeCost() override { return problem_->ComputeCost(); }

 private:
  const robot::RobotModel& robot_;
  const PlanRequest& request_;
  const PlannerSettings& settings_;
  GpProblemOptions options_;
  std::optional<GpProblem> problem_;  // of the present guess
};

}  // namespace

std::unique_ptr<TrajectoryOptimizer> GpPlanner::MakeOptimizer(const PlanRequest& request) const {
  return std::make_unique<CeresOptimizer>(robot(), request, settings(), gp(),
                                          residuals_ == Residuals::kCondensed);
}

PlannerKind GpmpKind() {
  return KindOf<GpPlanner>(
      "trajectory optimisation after GPMP2, with limits, detours and the links kept apart",
      GpParameters());
}

}  // namespace sidestep::planner
