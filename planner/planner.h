#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "sidestep/core/trajectory.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/limit_use.h"
#include "sidestep/planner/plan_judge.h"
#include "sidestep/planner/plan_request.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// What is true of the plan that was found; the first that applies, from the bottom up.
enum class PlanStatus {
  kSolved,        ///< the planner stopped by itself and the plan is free in the given field
  kNotConverged,  ///< free, but the budget or a cap was reached: the best so far
  kShortOfGoal,   ///< free and within limits, but it ends elsewhere: the goal is blocked
  kOverLimits,    ///< free, but it exceeds a limit that the settings ask to keep
  kInCollision,   ///< it touches something in the given field
  kTimedOut,      ///< no plan: the budget was spent before there was one
  kFailed         ///< no plan, or none that answers the request
};
/// "solved", "not_converged", "short_of_goal", "over_limits", "in_collision", "timed_out",
/// "failed".
std::string ToString(PlanStatus status);

struct PlanCost {
  double gp = 0, obstacle = 0, limits = 0, goal = 0;
  double total() const { return gp + obstacle + limits + goal; }
};

/// What a planner has found. How good it is, is not for the planner to say.
struct PlanAnswer {
  std::optional<Trajectory> trajectory = {};  ///< on the request's grid; none if none was found
  bool converged = false;  ///< it stopped by itself, not at a cap or a spent budget
  int iterations = 0;      ///< of all solves together
  int spent = 0;           ///< of the budget's iterations; at least as many
  SearchProgress progress = {};
  /// Each part half the sum of squared residuals; what only fixed states decide is left out.
  PlanCost cost = {};
  // For a person:
  std::string why_none = {};   ///< where there is no trajectory
  std::string why_short = {};  ///< where it ends elsewhere than at the goal
};

struct PlanResult {
  PlanStatus status = PlanStatus::kFailed;
  std::optional<Trajectory> trajectory;  ///< finite, on the request's grid; none: see `reason`
  std::string reason;                    ///< why there is none, or why it ends short of the goal
  bool converged = false;  ///< whether the planner stopped by itself, whatever the status
  int iterations = 0;
  int spent = 0;            ///< of the budget's iterations
  SearchProgress progress;  ///< for the next request
  PlanCost cost;
  Clearance clearance;  ///< of the free part, in the field; without a trajectory, none measured
  LimitUse limit_use;   ///< of the free part, of the robot's own limits
  /// Of the free part: the largest share of a limit that the settings ask to keep, or 0.
  double limit_share = 0;
};

/// What a planner can do beyond what every planner promises; tests hold it to what it declares.
struct PlannerCapabilities {
  /// Its plans end at rest at the goal, unless they are said to end short of it.
  bool reaches_goal = false;
  bool avoids_obstacles = false;  ///< it looks for a plan that is free
  /// Work is counted in iterations of `gpmp`: so many of this planner's, or solves begun, take no
  /// more time than one. A constant, so that budgets are the same on every machine.
  int iterations_for_one = 1;
};

/// Request in, result out; no hidden state: equal requests give equal bits, unless the budget goes
/// by the clock. This class checks what goes in and judges what comes out, by the same measure for
/// all planners: on the request's grid, finite, fixed states as they were, free, within limits. A
/// planner that throws, or breaks one of these promises, has failed.
class Planner {
 public:
  Planner(const Planner&) = delete;
  Planner& operator=(const Planner&) = delete;
  virtual ~Planner() = default;
  /// @throws std::invalid_argument for a request that means nothing (CheckPlanRequest).
  PlanResult Plan(const PlanRequest& request) const;

  /// Of the direct motion, with this planner's robot and settings (planner/direct_time.h).
  double DirectTime_s(const Eigen::VectorXd& q_start, const Eigen::VectorXd& q_goal) const;

  virtual PlannerCapabilities capabilities() const { return {}; }
  /// In this planner's iterations, for a loop that gives each planner the same time.
  /// @param work iterations of `gpmp`, > 0.
  PlanBudget BudgetOf(int work) const;
  const robot::RobotModel& robot() const { return robot_; }
  /// By which results are judged.
  const ClearanceMeter& clearance_meter() const { return clearance_meter_; }

 protected:
  /// @param settings by whose limits results are judged, whether the planner heeds them or not.
  /// @throws std::invalid_argument for settings out of range.
  Planner(const robot::RobotModel& robot, const PlannerSettings& settings);

  const PlannerSettings& settings() const { return settings_; }

 private:
  /// @param request has been checked.
  /// @param judge says of a motion what will be said of the answer, for who weighs several.
  virtual PlanAnswer DoPlan(const PlanRequest& request, PlanJudge& judge) const = 0;
  robot::RobotModel robot_;
  PlannerSettings settings_;
  ClearanceMeter clearance_meter_;  // of robot_
};

}  // namespace sidestep::planner
