#pragma once

#include <Eigen/Core>

#include "sidestep/record/recording.h"

namespace sidestep::bench {

/// The goal is reached when no joint is further than this from it ...
inline constexpr double kGoalTolerance = 0.02;  // rad
/// ... and none is faster than this.
inline constexpr double kGoalSpeed = 0.05;  // rad/s

bool AtGoal(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& q_goal);

/// The first control tick at the goal [s]; NaN if there is none.
double TimeToGoal(const record::Recording& recording);
/// max_i |q_i - q_goal_i| at the last tick [rad].
double GoalError(const record::Recording& recording);
/// The GP prior cost (Qc = I) of the measured motion, sampled every 0.1 s from the start.
double GpCostOfMotion(const record::Recording& recording);
/// Root mean square of the commanded jerk over ticks and joints, until the goal [rad/s^3].
double JerkRms(const record::Recording& recording);
/// max over ticks and joints of |q_command - q| [rad].
double TrackingError(const record::Recording& recording);
/// max over ticks and joints of |v_command| / v_max.
double VelocityUse(const record::Recording& recording);

}  // namespace sidestep::bench
