#pragma once

#include <Eigen/Core>
#include <atomic>
#include <chrono>
#include <limits>
#include <optional>
#include <string>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// How much work an answer may cost. Without any of these a planner goes on until it is done, which
/// its own settings see to.
struct PlanBudget {
  /// Iterations of all solves together, > 0, where each solve counts one more: to begin one costs
  /// as much. Work that is counted is the same on every machine, so runs in simulated time are held
  /// to this.
  int iterations = std::numeric_limits<int>::max();
  /// For a loop that goes by the wall clock: the answer is to be there by then.
  std::optional<std::chrono::steady_clock::time_point> deadline;
  /// Borrowed. Once true, what was found so far is the answer.
  const std::atomic<bool>* stop = nullptr;

  /// Whether to come to an end, after so many iterations or because the time is up.
  bool IsSpent(int iterations_done) const;
  /// Half of what is left once so many iterations are done, for who has something else to do too.
  PlanBudget HalfOfWhatIsLeft(int iterations_done) const;
  /// All of it; at least one iteration.
  PlanBudget WhatIsLeft(int iterations_done) const;
  /// The same whatever has been done: the deadline has come, or somebody says stop.
  bool IsTimeUp() const;
};

/// A plan, and when it begins: its state k is at start + t_s(k).
struct TimedPlan {
  Trajectory trajectory;
  EpisodeTime start;
};

/// Where to take up a search that its budget cut short. A planner tells it with its answer, and is
/// told it with the next request of the same kind; what it means is up to the planner.
struct SearchProgress {
  bool cut_short = false;  ///< else there is nothing to take up
  int next_seed = 0;       ///< those before it, in the planner's own order, have been tried
  std::optional<TimedPlan> best = {};  ///< what was found and is not free yet
};

/// Support states k = 0 ... num_states-1 at start + k step. References are borrowed for the call.
struct PlanRequest {
  const sdf::DistanceField* field = nullptr;  ///< sampled at absolute times
  EpisodeTime start;                          ///< of support state 0
  double step_s = 0;                          ///< between support states, > 0
  int num_states = 0;                         ///< >= 2
  Eigen::VectorXd q_start, v_start;           ///< shape n: state 0
  Eigen::VectorXd q_goal;                     ///< shape n; the goal velocity is zero
  /// The first guess: a good motion on the same grid, such as the plan that runs; its state 0 gives
  /// way to (q_start, v_start). Without one the planner makes its own guess.
  std::optional<Trajectory> initial;
  /// The first `num_fixed` states (>= 1, < num_states) are what the robot will do anyway and stay
  /// exactly as in `initial`. Without `initial` the robot rests there, and v_start must be zero if
  /// num_fixed > 1.
  int num_fixed = 1;
  PlanBudget budget;
  SearchProgress progress = {};
};

/// @param n joints of the robot.
/// @throws std::invalid_argument for a wrong shape, a value that is not finite, no field, ...
void CheckPlanRequest(const PlanRequest& request, int n);

/// What keeps a trajectory from answering a request: its shape, numbers that are not finite,
/// another grid, a fixed state that it changes. Empty if nothing does.
std::string WhyNoAnswer(const PlanRequest& request, const Trajectory& trajectory);

}  // namespace sidestep::planner
