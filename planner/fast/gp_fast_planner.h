#pragma once

#include <memory>

#include "sidestep/planner/gp_objective.h"
#include "sidestep/planner/gp_settings.h"
#include "sidestep/planner/objective/arm_group.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/planner/seeded_planner.h"

namespace sidestep::planner {

/// `gpmp_fast`: the objective and the seeds of `gpmp`, solved by our own block tridiagonal
/// Levenberg-Marquardt (planner/fast/levenberg_marquardt.h) instead of Ceres'.
class GpFastPlanner final : public SeededPlanner {
 public:
  /// @throws std::invalid_argument for settings out of range.
  GpFastPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
                const GpSettings& gp = {});

  PlannerCapabilities capabilities() const override {
    PlannerCapabilities mine = SeededPlanner::capabilities();
    mine.iterations_for_one = 8;
    return mine;
  }

 private:
  std::unique_ptr<TrajectoryOptimizer> MakeOptimizer(const PlanRequest& request) const override;

  GpProblemOptions options_;
  std::shared_ptr<const obstacle_kernels::Arm> arm_;  // as these see the robot
};

PlannerKind GpmpFastKind();

}  // namespace sidestep::planner
