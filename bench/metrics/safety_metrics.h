#pragma once

#include "core/recording.h"

namespace sidestep {

/// When the robot first touched anything it may not touch [s]; NaN if never, or without truth.
double FirstContact(const Recording& recording);
/// Least true clearance over the episode [m]; negative: penetration. NaN without truth.
double MinClearance(const Recording& recording);
/// How many planning cycles were run, and how many plans the robot was given.
double Replans(const Recording& recording);
double PlansAccepted(const Recording& recording);

}  // namespace sidestep
