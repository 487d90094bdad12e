#pragma once

#include "sidestep/record/recording.h"

namespace sidestep {

/// A recording with every field set, no two alike, and ragged parts ragged.
/// @param num_control control ticks; 5000 are more rows than one chunk of the file holds.
record::Recording FullRecording(int num_control = 5000);

}  // namespace sidestep
