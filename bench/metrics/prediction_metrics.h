#pragma once

#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"

namespace sidestep::bench {

/// How often tracking has said of a thing that it begins to move; one that rests in between counts
/// again.
double ThingsMoved(const record::Recording& recording);

/// How far predictions were off [m]: the root mean square, over all planning cycles and the objects
/// in them, of the distance from where the box around an object was predicted to be `ahead` of the
/// cycle to where the obstacle truly was then. An object is taken for the obstacle that was nearest
/// to it in that cycle. NaN if nothing was predicted so far ahead, or the episode ended before.
double PredictionError(const record::Recording& recording, HorizonOffset ahead);

double PredictionErrorAfter100Ms(const record::Recording& recording);
double PredictionErrorAfter300Ms(const record::Recording& recording);
double PredictionErrorAfter500Ms(const record::Recording& recording);
double PredictionErrorAfter1000Ms(const record::Recording& recording);
double PredictionErrorAfter2000Ms(const record::Recording& recording);

}  // namespace sidestep::bench
