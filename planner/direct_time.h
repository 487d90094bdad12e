#pragma once

#include <Eigen/Core>

#include "sidestep/planner/planner_settings.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::planner {

/// The least time [s] in which the direct motion from rest to rest (MakeDirectMotion) keeps the
/// limits of velocity and acceleration that the settings ask for, and their speed of the tool to a
/// thousandth. A shorter horizon would ask for what cannot be had.
/// @param q_start, q_goal shape n.
double DirectTime_s(const robot::RobotModel& robot, const PlannerSettings& settings,
                    const Eigen::VectorXd& q_start, const Eigen::VectorXd& q_goal);

}  // namespace sidestep::planner
