#pragma once

#include "sidestep/record/recording.h"

namespace sidestep::bench {

// How much a run used of the limits that its motion was asked to keep to, Recording::limits: the
// largest share of all joints and moments, above 1 where one was not kept. NaN if no joint has such
// a limit, or there is nothing to measure.

/// Of the plans that were given to the robot, each from the support state at or before the moment
/// when it takes effect. A plan is a chain of cubics: its velocity and acceleration are exact. Its
/// jerk is that within the cubics; at a support state the acceleration jumps, no jerk is defined,
/// and it is the tracker that rounds the corner (CommandedJerkUse). Torque rates are not told: a
/// plan holds no torques, and this module knows no masses.
double PlannedVelocityUse(const record::Recording& recording);
double PlannedAccelerationUse(const record::Recording& recording);
double PlannedJerkUse(const record::Recording& recording);

/// Of what the motors were told at each control tick. Jerk and torque rate are differences of
/// acceleration and torque from tick to tick.
double CommandedVelocityUse(const record::Recording& recording);
double CommandedAccelerationUse(const record::Recording& recording);
double CommandedJerkUse(const record::Recording& recording);
double CommandedTorqueRateUse(const record::Recording& recording);

}  // namespace sidestep::bench
