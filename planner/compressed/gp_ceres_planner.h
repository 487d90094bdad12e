#pragma once

#include <memory>

#include "sidestep/planner/planner_settings.h"
#include "sidestep/planner/seeded_planner.h"

namespace sidestep::planner {

/// `gpmp_ceres`: the objective and the seeds of `gpmp`, solved by Ceres in the fewest and smallest
/// residual blocks (planner/compressed/compressed_problem.h).
class GpCeresPlanner final : public SeededPlanner {
 public:
  /// @throws std::invalid_argument for settings out of range.
  GpCeresPlanner(const robot::RobotModel& robot, const PlannerSettings& settings)
      : SeededPlanner(robot, settings) {}

 private:
  std::unique_ptr<TrajectoryOptimizer> MakeOptimizer(const PlanRequest& request) const override;
};

std::unique_ptr<Planner> MakeGpCeresPlanner(const robot::RobotModel& robot,
                                            const PlannerSettings& settings);

}  // namespace sidestep::planner
