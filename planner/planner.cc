#include "sidestep/planner/planner.h"

#include <cmath>
#include <stdexcept>

#include "sidestep/planner/clearance.h"

namespace sidestep::planner {
namespace {

// Support states stand where they should to within this share of a step.
constexpr double kGridTolerance = 1e-6;

void Require(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument("plan request: " + what);
}

void RequireVector(const Eigen::VectorXd& vector, int n, const std::string& name) {
  Require(vector.size() == n, name + " must have length " + std::to_string(n) + ", has " +
                                  std::to_string(vector.size()));
  Require(vector.allFinite(), name + " must be finite");
}

void CheckRequest(const PlanRequest& request, int n) {
  Require(request.field != nullptr, "there is no field");
  Require(std::isfinite(request.start.seconds()), "start must be finite");
  Require(std::isfinite(request.step_s) && request.step_s >= kLeastInterval_s,
          "step_s must be at least 1e-6 and finite");
  Require(request.num_states >= 2, "num_states must be >= 2");
  RequireVector(request.q_start, n, "q_start");
  RequireVector(request.v_start, n, "v_start");
  RequireVector(request.q_goal, n, "q_goal");
  Require(request.num_fixed >= 1 && request.num_fixed < request.num_states,
          "num_fixed must be >= 1 and < num_states");
  if (!request.initial) {
    Require(request.num_fixed == 1 || request.v_start.isZero(0),
            "without an initial guess, several fixed states need a start at rest");
    return;
  }
  CheckTrajectory(*request.initial);
  Require(request.initial->num_joints() == n, "initial must have as many joints as the robot");
  Require(request.initial->num_states() == request.num_states,
          "initial must have num_states states");
  for (int k = 0; k < request.num_states; ++k) {
    Require(
        std::abs(request.initial->t_s(k) - k * request.step_s) <= kGridTolerance * request.step_s,
        "initial must stand on the request's grid");
  }
  Require(request.num_fixed == 1 || (request.initial->q.col(0) == request.q_start &&
                                     request.initial->v.col(0) == request.v_start),
          "with several fixed states, initial must begin at q_start, v_start");
}

}  // namespace

std::string ToString(PlanStatus status) {
  switch (status) {
    case PlanStatus::kSolved:
      return "solved";
    case PlanStatus::kNotConverged:
      return "not_converged";
    case PlanStatus::kOverLimits:
      return "over_limits";
    case PlanStatus::kInCollision:
      return "in_collision";
  }
  throw std::invalid_argument("unknown PlanStatus");
}

Planner::Planner(const robot::RobotModel& robot, const PlannerSettings& settings)
    : robot_(robot), settings_(settings) {
  CheckPlannerSettings(settings);
}

PlanResult Planner::Plan(const PlanRequest& request) const {
  CheckRequest(request, robot_.num_joints());
  return DoPlan(request);
}

PlanResult Planner::MakeResult(const PlanRequest& request, const Trajectory& trajectory,
                               bool converged) const {
  const auto at = [&](int k) { return request.start + HorizonOffset(trajectory.t_s(k)); };
  PlanResult result;
  result.trajectory = trajectory;
  result.clearance = MeasureClearance(robot_, *request.field, trajectory, request.start,
                                      at(request.num_fixed - 1), at(request.num_states - 1));
  result.limit_use = MeasureLimitUse(robot_, trajectory, request.num_fixed - 1);
  if (result.clearance.first_contact) {
    result.status = PlanStatus::kInCollision;
  } else if (!KeepsLimits(result.limit_use, settings_)) {
    result.status = PlanStatus::kOverLimits;
  } else {
    result.status = converged ? PlanStatus::kSolved : PlanStatus::kNotConverged;
  }
  return result;
}

}  // namespace sidestep::planner
