#pragma once

#include <memory>

#include "planner/planner.h"
#include "planner/planner_settings.h"

namespace sidestep {

/// `straight_line`: the direct motion to the goal with a smooth timing, whatever is in its way. The
/// yardstick for planners that look.
class StraightLinePlanner final : public Planner {
 public:
  explicit StraightLinePlanner(const RobotModel& robot) : Planner(robot) {}

 private:
  PlanResult DoPlan(const PlanRequest& request) const override;
};

std::unique_ptr<Planner> MakeStraightLinePlanner(const RobotModel& robot,
                                                 const PlannerSettings& settings);

}  // namespace sidestep
