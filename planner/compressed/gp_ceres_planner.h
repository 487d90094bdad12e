#pragma once

#include <memory>

#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/gp_settings.h"
#include "sidestep/planner/objective/arm_group.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/planner/seeded_planner.h"

namespace sidestep::planner {

/// `gpmp_ceres`: the objective and the seeds of `gpmp`, solved by Ceres in the fewest and smallest
/// residual blocks (planner/compressed/compressed_problem.h).
class GpCeresPlanner final : public SeededPlanner {
 public:
  /// @throws std::invalid_argument for settings out of range.
  GpCeresPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
                 const GpSettings& gp = {});

 private:
  std::unique_ptr<TrajectoryOptimizer> MakeOptimizer(const PlanRequest& request) const override;

  GpProblemOptions options_;
  std::shared_ptr<const obstacle_kernels::Arm> arm_;  // as these see the robot
};

PlannerKind GpmpCeresKind();

}  // namespace sidestep::planner
