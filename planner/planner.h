#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/limit_use.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// What is true of the plan that was found; the first that applies, from the bottom up.
enum class PlanStatus {
  kSolved,        ///< the planner stopped by itself and the plan is free in the given field
  kNotConverged,  ///< free, but the iteration cap was reached: the best so far
  kOverLimits,    ///< free, but it exceeds a limit that the settings ask to keep
  kInCollision    ///< it touches something in the given field
};
/// "solved", "not_converged", "over_limits", "in_collision".
std::string ToString(PlanStatus status);

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
};

struct PlanCost {
  double gp = 0, obstacle = 0, limits = 0, goal = 0;
  double total() const { return gp + obstacle + limits + goal; }
};

struct PlanResult {
  PlanStatus status = PlanStatus::kNotConverged;
  Trajectory trajectory;  ///< always filled and finite, on the request's grid
  int iterations = 0;     ///< of all solves together
  /// Each part half the sum of squared residuals; what only fixed states decide is left out.
  PlanCost cost;
  Clearance clearance;  ///< of the free part, in the field
  LimitUse limit_use;   ///< of the free part, of the robot's own limits
};

/// What a planner can do beyond what every planner promises; tests hold it to what it declares.
struct PlannerCapabilities {
  bool reaches_goal = false;      ///< its plans end at the goal, at rest, whatever is in the way
  bool avoids_obstacles = false;  ///< it looks for a plan that is free
};

/// Request in, result out; no hidden state: equal requests give equal bits. Every planner answers
/// on the request's grid with finite numbers, leaves fixed states as they are, and says whether its
/// plan touches something.
class Planner {
 public:
  virtual ~Planner() = default;
  /// @throws std::invalid_argument for a wrong shape, a value that is not finite, no field, ...
  PlanResult Plan(const PlanRequest& request) const;

  virtual PlannerCapabilities capabilities() const { return {}; }
  const robot::RobotModel& robot() const { return robot_; }

 protected:
  /// @param settings by whose limits results are judged, whether the planner heeds them or not.
  /// @throws std::invalid_argument for settings out of range.
  Planner(const robot::RobotModel& robot, const PlannerSettings& settings);

  const PlannerSettings& settings() const { return settings_; }

  /// The result for a trajectory on the request's grid, judged; without cost and iterations.
  PlanResult MakeResult(const PlanRequest& request, const Trajectory& trajectory,
                        bool converged) const;

 private:
  virtual PlanResult DoPlan(const PlanRequest& request) const = 0;  // `request` has been checked.
  robot::RobotModel robot_;
  PlannerSettings settings_;
};

}  // namespace sidestep::planner
