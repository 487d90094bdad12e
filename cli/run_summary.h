#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/core/samples.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Prints what came of an episode, a line each.
void PrintOutcome(const bench::EpisodeResult& result, const scenarios::Scenario& scenario);

/// What was found while a robot moved, a line each. An answer that was slow to make is told of a
/// real robot alone: a simulated one shares this machine, so that it says nothing.
std::string FindingsText(const std::vector<SafetyEvent>& findings, bool is_real_robot);

}  // namespace sidestep::cli
