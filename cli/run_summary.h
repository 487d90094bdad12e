#pragma once

#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Prints what came of an episode, a line each.
void PrintOutcome(const bench::EpisodeResult& result, const scenarios::Scenario& scenario);

/// The same, and the folder that its files are in.
void PrintSummary(const bench::EpisodeResult& result, const scenarios::Scenario& scenario,
                  const std::string& out);

}  // namespace sidestep::cli
