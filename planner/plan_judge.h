#pragma once

#include <optional>
#include <vector>

#include "sidestep/core/trajectory.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/limit_use.h"
#include "sidestep/planner/plan_request.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// What is true of a motion that answers a request, from its last fixed state to its end.
struct Verdict {
  Clearance clearance;        ///< in the request's field
  LimitUse limit_use;         ///< of the robot's own limits
  double limit_share = 0;     ///< the largest, of those that the settings ask for
  bool keeps_limits = false;  ///< all of these

  bool is_free() const { return !clearance.first_contact; }
};

/// Judges the motions that may answer one request, one after the other: those that a planner weighs
/// and the one it answers with, each looked at once. Not for several threads.
class PlanJudge {
 public:
  /// Borrows all.
  PlanJudge(const robot::RobotModel& robot, const ClearanceMeter& clearance_meter,
            const PlannerSettings& settings, const PlanRequest& request);

  /// @param trajectory on the request's grid, finite.
  Verdict Judge(const Trajectory& trajectory);

 private:
  struct Judged {
    Trajectory trajectory;
    Verdict verdict;
  };
  const robot::RobotModel& robot_;
  const ClearanceMeter& clearance_meter_;
  const PlannerSettings& settings_;
  const PlanRequest& request_;
  std::vector<Judged> judged_;
};

}  // namespace sidestep::planner
