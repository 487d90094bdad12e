#include "sidestep/planner/plan_judge.h"

#include "sidestep/core/time.h"

namespace sidestep::planner {

PlanJudge::PlanJudge(const robot::RobotModel& robot, const ClearanceMeter& clearance_meter,
                     const PlannerSettings& settings, const PlanRequest& request)
    : robot_(robot), clearance_meter_(clearance_meter), settings_(settings), request_(request) {}

Verdict PlanJudge::Judge(const Trajectory& trajectory) {
  for (const Judged& judged : judged_) {
    if (judged.trajectory.q == trajectory.q && judged.trajectory.v == trajectory.v &&
        judged.trajectory.t_s == trajectory.t_s) {
      return judged.verdict;
    }
  }
  const auto at = [&](int k) { return request_.start + HorizonOffset(trajectory.t_s(k)); };
  Verdict verdict;
  verdict.clearance =
      clearance_meter_.Measure(*request_.field, trajectory, request_.start,
                               at(request_.num_fixed - 1), at(request_.num_states - 1));
  verdict.limit_use = MeasureLimitUse(robot_, trajectory, request_.num_fixed - 1);
  verdict.limit_share = LargestShare(verdict.limit_use, settings_);
  verdict.keeps_limits = KeepsLimits(verdict.limit_use, settings_);
  judged_.push_back({trajectory, verdict});
  return verdict;
}

}  // namespace sidestep::planner
