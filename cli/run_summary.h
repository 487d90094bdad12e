#pragma once

#include "sidestep/bench/episode.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Prints what came of an episode, a line each.
void PrintOutcome(const bench::EpisodeResult& result, const scenarios::Scenario& scenario);

}  // namespace sidestep::cli
