#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/time.h"
#include "core/trajectory.h"
#include "robot/robot_model.h"
#include "sdf/distance_field.h"

namespace sidestep {

enum class PlanStatus {
  kSolved,       ///< the optimiser stopped by itself and the plan is free in the given field
  kInCollision,  ///< it stopped, but the plan touches something in the given field
  kNotConverged  ///< the iteration cap was reached; the trajectory is the best so far
};
std::string ToString(PlanStatus status);

/// Support states k = 0 ... num_states-1 at start + k step. References are borrowed for the call.
struct PlanRequest {
  const DistanceField* field = nullptr;  ///< sampled at absolute times
  EpisodeTime start;                     ///< of support state 0
  double step_s = 0;                     ///< between support states, > 0
  int num_states = 0;                    ///< >= 2
  Eigen::VectorXd q_start, v_start;      ///< shape n
  Eigen::VectorXd q_goal;                ///< shape n; the goal velocity is zero
  /// The first guess (same grid). Without one: the straight line from start to goal.
  std::optional<Trajectory> initial;
  /// The first `num_fixed` states stay exactly as in `initial`: what the robot will do anyway.
  /// At least 1; state 0 is then (q_start, v_start). More than 1 needs `initial`.
  int num_fixed = 1;
};

struct PlanCost {
  double gp = 0, obstacle = 0, limits = 0, goal = 0;
  double total() const { return gp + obstacle + limits + goal; }
};

struct PlanResult {
  PlanStatus status = PlanStatus::kNotConverged;
  Trajectory trajectory;  ///< always filled, on the request's grid
  int iterations = 0;
  PlanCost cost;                 ///< each part half the sum of squared residuals
  double min_clearance_m = 0;    ///< least distance - radius along the free part, in the field
  int samples_outside_grid = 0;  ///< sphere positions of the final check outside the mapped box
};

/// Request in, result out; no hidden state: equal requests give equal bits.
class Planner {
 public:
  virtual ~Planner() = default;
  /// @throws std::invalid_argument for a wrong shape, a value that is not finite, no field, ...
  PlanResult Plan(const PlanRequest& request) const;

 protected:
  explicit Planner(const RobotModel& robot) : robot_(robot) {}
  const RobotModel& robot() const { return robot_; }

 private:
  virtual PlanResult DoPlan(const PlanRequest& request) const = 0;  // `request` has been checked.
  RobotModel robot_;
};

}  // namespace sidestep
