#pragma once

#include "core/recording.h"
#include "core/time.h"

namespace sidestep {

/// How far predictions were off [m]: the root mean square, over all planning cycles and the objects
/// in them, of the distance from where the box around an object was predicted to be `ahead` of the
/// cycle to where the obstacle truly was then. An object is taken for the obstacle that was nearest
/// to it in that cycle. NaN if nothing was predicted so far ahead, or the episode ended before.
double PredictionError(const Recording& recording, HorizonOffset ahead);

double PredictionErrorAfter100Ms(const Recording& recording);
double PredictionErrorAfter300Ms(const Recording& recording);
double PredictionErrorAfter500Ms(const Recording& recording);
double PredictionErrorAfter1000Ms(const Recording& recording);
double PredictionErrorAfter2000Ms(const Recording& recording);

}  // namespace sidestep
