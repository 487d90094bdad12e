#pragma once

#include "sidestep/record/recording.h"

namespace sidestep::bench {

/// When the robot first touched anything it may not touch [s]; NaN if never, or without truth.
double FirstContact(const record::Recording& recording);
/// Least true clearance over the episode [m]; negative: penetration. NaN without truth.
double MinClearance(const record::Recording& recording);
/// How many planning cycles were run, and how many plans the robot was given.
double Replans(const record::Recording& recording);
double PlansAccepted(const record::Recording& recording);
/// How many of the cycles wanted to go on when their budget was spent, and how many found their
/// goal blocked and made a plan that ends near it.
double ReplansCutShort(const record::Recording& recording);
double ReplansShortOfGoal(const record::Recording& recording);
/// How many positions of spheres along the plans of all cycles lay outside the mapped box, where
/// only what is known exactly and what moves was seen.
double SamplesOutsideGrid(const record::Recording& recording);

}  // namespace sidestep::bench
