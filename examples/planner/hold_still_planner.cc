// A planner that stays where it is. Copy this file to planner/, add the line of planners.def beside
// it to planner/planners.def, and `sidestep run hsr_walkway --set planner.name=hold_still` runs it.
#include <memory>

#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_kind.h"
#include "sidestep/planner/planner_settings.h"

namespace sidestep::planner {
namespace {

class HoldStillPlanner final : public Planner {
 public:
  HoldStillPlanner(const robot::RobotModel& robot, const PlannerSettings& settings)
      : Planner(robot, settings) {}

 private:
  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge&) const override {
    const int n = robot().num_joints(), num_states = request.num_states;
    Trajectory trajectory;
    trajectory.t_s = Eigen::VectorXd::LinSpaced(num_states, 0, num_states - 1) * request.step_s;
    trajectory.q = request.q_start.replicate(1, num_states);
    trajectory.v = Eigen::MatrixXd::Zero(n, num_states);
    trajectory.v.col(0) = request.v_start;
    if (request.num_fixed > 1 && request.initial) {  // What the robot will do in any case stays.
      const int last = request.num_fixed - 1;
      trajectory.q = request.initial->q.col(last).replicate(1, num_states);
      trajectory.q.leftCols(last) = request.initial->q.leftCols(last);
      trajectory.v.leftCols(last + 1) = request.initial->v.leftCols(last + 1);
    }
    return {.trajectory = trajectory, .converged = true};
  }
};

}  // namespace

PlannerKind HoldStillKind() {
  return {"stays where it is",
          {},  // Nothing can be set of it; planner/gp_settings.cc has those of another one.
          [](const robot::RobotModel& robot, const PlannerSettings& settings, const Parameters&) {
            return std::make_unique<HoldStillPlanner>(robot, settings);
          }};
}

}  // namespace sidestep::planner
