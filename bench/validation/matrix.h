#pragma once

#include <vector>

#include "sidestep/bench/validation/validation_case.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// The episodes of a validation: obstacle behaviours, speeds, perception, timing and faults. Which
/// obstacle speeds, is told by what the scenario declares.
/// @param draws of each (seeds, for a person), >= 1. @param with_wire whether there is a robot
/// server for this robot.
std::vector<ValidationCase> ValidationMatrix(const scenarios::Scenario& scenario, int draws,
                                             bool with_wire);

/// Episodes within the envelope, at random: the draws from `first` to `last`.
std::vector<ValidationCase> SoakCases(const scenarios::Scenario& scenario, int first, int last);

}  // namespace sidestep::bench
