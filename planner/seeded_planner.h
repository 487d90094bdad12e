#pragma once

#include <memory>
#include <optional>

#include "sidestep/planner/gp_settings.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/planner/trajectory_optimizer.h"

namespace sidestep::planner {

/// Which guesses are tried, for how long, and which of the answers counts: the policy of all
/// planners that optimise a trajectory, whatever solver they do it with. It caps iterations; time
/// only where the request's budget does.
///
/// A cold start is solved in two stages, first without joint limits and then with them from there:
/// stiff limits from the beginning keep the solver on the wrong side of obstacles. A warm start is
/// solved with limits at once, and left as it is where that spoils it. A plan is judged by its
/// clearance, not by its cost. If a cold one is not free within the limits, or a warm one not free,
/// direct motions with other timings are tried as seeds until one is, and the best counts. Where
/// all of them touch something, a cold start is followed by detours (planner/seeds.h). Such seeds
/// get few iterations, and no second stage if the first leaves them less safe than the best so far.
/// What they and a cold start find free and over a limit is solved again with stiffer limits, once
/// it is finished: the best of such seeds that is free and not finished is.
///
/// Where the goal is blocked when the horizon ends, no plan to it can be free: then the plan is one
/// to the nearest place that is (planner/free_goal.h), found in the same way.
///
/// A search that its budget cuts short goes on in the next request: it takes up the best plan so
/// far, and then the guesses from where it stopped, in a ring.
class SeededPlanner : public Planner {
 public:
  PlannerCapabilities capabilities() const override {
    return {.reaches_goal = true, .avoids_obstacles = true};
  }

 protected:
  /// @throws std::invalid_argument for settings out of range.
  SeededPlanner(const robot::RobotModel& robot, const PlannerSettings& settings,
                const GpSettings& gp)
      : Planner(robot, settings), gp_(gp) {}

  const GpSettings& gp() const { return gp_; }

 private:
  /// `request` has been checked; the optimizer borrows it.
  virtual std::unique_ptr<TrajectoryOptimizer> MakeOptimizer(const PlanRequest& request) const = 0;

  PlanAnswer DoPlan(const PlanRequest& request, PlanJudge& judge) const final;
  enum class Stages {
    kWithLimits,  ///< for a warm start
    kBoth         ///< for a cold one
  };
  struct Candidate {
    PlanAnswer answer;
    Verdict verdict;
  };
  class Search;
  PlanAnswer TryAll(const PlanRequest& request, PlanJudge& judge) const;
  /// If the goal is blocked, the same request with the nearest one that is free.
  std::optional<PlanRequest> WithFreeGoal(const PlanRequest& request) const;
  bool EndsAtGoalOf(const PlanRequest& request, const Trajectory& trajectory) const;
  /// Whether the plan that runs does.
  bool LeadsToGoal(const PlanRequest& request) const;
  /// Free within the limits that are asked for comes before free within the robot's own, that
  /// before free, and free before not free; then what is safer.
  bool IsBetter(const Verdict& a, const Verdict& b) const;

  GpSettings gp_;
};

}  // namespace sidestep::planner
