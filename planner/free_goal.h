#pragma once

#include <Eigen/Core>
#include <optional>

#include "sidestep/core/time.h"
#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// Whether something is where the robot would be at rest in `q` at time `t`.
bool IsBlocked(const robot::RobotModel& robot, const sdf::DistanceField& field,
               const Eigen::VectorXd& q, EpisodeTime t);

/// Where to wait for a goal that is blocked at time `t`: a configuration near it, within the
/// robot's position limits if the goal is, that keeps half of the safety margin then; none if a
/// descent from the goal finds none. It gives way no further than it has to: the pull back to the
/// goal weakens step by step.
std::optional<Eigen::VectorXd> FindFreeGoal(const robot::RobotModel& robot,
                                            const sdf::DistanceField& field,
                                            const PlannerSettings& settings,
                                            const Eigen::VectorXd& q_goal, EpisodeTime t);

}  // namespace sidestep::planner
