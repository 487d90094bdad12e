#pragma once

#include <memory>

#include "sidestep/planner/gp_settings.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/planner/seeded_planner.h"

namespace sidestep::planner {

/// `gpmp`: trajectory optimisation after GPMP2, by Ceres' Levenberg-Marquardt in one thread: the
/// readable reference that faster planners are held to. Its seeds: planner/seeded_planner.h. Links
/// that the robot's self_collision() names are kept 0.05 m apart.
///
/// Source: Mukadam et al., "Continuous-time Gaussian process motion planning via probabilistic
/// inference", IJRR 37(11):1319-1340, 2018.
class GpPlanner final : public SeededPlanner {
 public:
  /// Of a configuration, one residual a sphere, or n + 1 to the same effect (obstacle_hinge.h).
  enum class Residuals { kPlain, kCondensed };
  /// @throws std::invalid_argument for settings out of range.
  GpPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
            const GpSettings& gp = {}, Residuals residuals = Residuals::kCondensed)
      : SeededPlanner(robot, settings, gp), residuals_(residuals) {}

 private:
  std::unique_ptr<TrajectoryOptimizer> MakeOptimizer(const PlanRequest& request) const override;

  Residuals residuals_;
};

PlannerKind GpmpKind();

}  // namespace sidestep::planner
