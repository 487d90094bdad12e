#pragma once

#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {

/// What is wrong with a run of a sweep, told where the sweep's file says it: `FILE:LINE:
/// axes.KEY: WHY`. As it is where something else is wrong, or there is no file.
InputError FaultInSweep(const bench::Sweep& sweep, const InputError& fault);

}  // namespace sidestep::cli
