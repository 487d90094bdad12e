#pragma once

#include <Eigen/Core>

#include "sidestep/record/recording.h"

namespace sidestep::bench {

/// When the arm arrived at the goal for the stay that made it count as reached (core/goal.h) [s];
/// NaN if it was not.
double TimeToGoal(const record::Recording& recording);
/// When that stay had lasted as long as asked, dwell_s [s].
double TimeToDwell(const record::Recording& recording);
/// max_i |q_i - q_goal_i| at the last tick [rad].
double GoalError(const record::Recording& recording);
/// The GP prior cost (Qc = I) of the measured motion, sampled every 0.1 s from the start.
double GpCostOfMotion(const record::Recording& recording);
/// Root mean square of the commanded jerk over ticks and joints, until the goal [rad/s^3].
double JerkRms(const record::Recording& recording);
/// max over ticks and joints of |q_command - q| [rad].
double TrackingError(const record::Recording& recording);

}  // namespace sidestep::bench
