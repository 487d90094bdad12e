#include "sidestep/planner/plan_request.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace sidestep::planner {
namespace {

// Support states stand where they should to within this share of a step.
constexpr double kGridTolerance = 1e-6;

void RequireOfRequest(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument("plan request: " + what);
}

void RequireVector(const Eigen::VectorXd& vector, int n, const std::string& name) {
  RequireOfRequest(vector.size() == n, name + " must have length " + std::to_string(n) + ", has " +
                                           std::to_string(vector.size()));
  RequireOfRequest(vector.allFinite(), name + " must be finite");
}

bool IsOnGrid(const PlanRequest& request, const Trajectory& trajectory) {
  for (int k = 0; k < request.num_states; ++k) {
    const double error_s = std::abs(trajectory.t_s(k) - k * request.step_s);
    if (error_s > kGridTolerance * request.step_s) return false;
  }
  return true;
}

// Whether state k is what the robot will do anyway.
bool IsAsFixed(const PlanRequest& request, const Trajectory& trajectory, int k) {
  if (k > 0 && request.initial) {
    return trajectory.q.col(k) == request.initial->q.col(k) &&
           trajectory.v.col(k) == request.initial->v.col(k);
  }
  return trajectory.q.col(k) == request.q_start && trajectory.v.col(k) == request.v_start;
}

}  // namespace

bool PlanBudget::IsSpent(int iterations_done) const {
  return iterations_done >= iterations || IsTimeUp();
}

PlanBudget PlanBudget::WhatIsLeft(int iterations_done) const {
  PlanBudget left = *this;
  left.iterations = std::max(1, iterations - iterations_done);
  return left;
}

PlanBudget PlanBudget::HalfOfWhatIsLeft(int iterations_done) const {
  PlanBudget half = WhatIsLeft(iterations_done);
  half.iterations -= half.iterations / 2;
  if (deadline) {
    const auto now = std::chrono::steady_clock::now();
    half.deadline = now + (*deadline - now) / 2;
  }
  return half;
}

bool PlanBudget::IsTimeUp() const {
  return (stop != nullptr && stop->load()) ||
         (deadline && std::chrono::steady_clock::now() >= *deadline);
}

void CheckPlanRequest(const PlanRequest& request, int n) {
  RequireOfRequest(request.field != nullptr, "there is no field");
  RequireOfRequest(std::isfinite(request.start.seconds()), "start must be finite");
  RequireOfRequest(std::isfinite(request.step_s) && request.step_s >= kLeastInterval_s,
                   "step_s must be at least 1e-6 and finite");
  RequireOfRequest(request.num_states >= 2, "num_states must be >= 2");
  RequireVector(request.q_start, n, "q_start");
  RequireVector(request.v_start, n, "v_start");
  RequireVector(request.q_goal, n, "q_goal");
  RequireOfRequest(request.num_fixed >= 1 && request.num_fixed < request.num_states,
                   "num_fixed must be >= 1 and < num_states");
  RequireOfRequest(request.budget.iterations >= 1, "budget.iterations must be >= 1");
  RequireOfRequest(request.progress.next_seed >= 0, "progress.next_seed must be >= 0");
  if (request.progress.best) {
    CheckTrajectory(request.progress.best->trajectory);
    RequireOfRequest(request.progress.best->trajectory.num_joints() == n,
                     "progress.best must have as many joints as the robot");
  }
  if (!request.initial) {
    RequireOfRequest(request.num_fixed == 1 || request.v_start.isZero(0),
                     "without an initial guess, several fixed states need a start at rest");
    return;
  }
  CheckTrajectory(*request.initial);
  RequireOfRequest(request.initial->num_joints() == n,
                   "initial must have as many joints as the robot");
  RequireOfRequest(request.initial->num_states() == request.num_states,
                   "initial must have num_states states");
  RequireOfRequest(IsOnGrid(request, *request.initial), "initial must stand on the request's grid");
  RequireOfRequest(request.num_fixed == 1 || (request.initial->q.col(0) == request.q_start &&
                                              request.initial->v.col(0) == request.v_start),
                   "with several fixed states, initial must begin at q_start, v_start");
}

std::string WhyNoAnswer(const PlanRequest& request, const Trajectory& trajectory) {
  try {
    CheckTrajectory(trajectory);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  if (trajectory.num_joints() != request.q_start.size()) {
    return "its trajectory has " + std::to_string(trajectory.num_joints()) + " joints, not " +
           std::to_string(request.q_start.size());
  }
  if (trajectory.num_states() != request.num_states || !IsOnGrid(request, trajectory)) {
    return "its trajectory does not stand on the grid that was asked for";
  }
  for (int k = 0; k < request.num_fixed; ++k) {
    if (!IsAsFixed(request, trajectory, k)) {
      return "its trajectory changes state " + std::to_string(k) + ", which is fixed";
    }
  }
  return "";
}

}  // namespace sidestep::planner
