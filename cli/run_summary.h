#pragma once

#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Prints what came of an episode, a line each.
void PrintOutcome(const bench::EpisodeResult& result, const scenarios::Scenario& scenario);

/// Writes trace.h5 and result.json into the folder `out`, and prints what came of the episode: that
/// and where it is written, or the whole result.json.
/// @throws std::runtime_error at the end, with the reason, if the episode was aborted.
void KeepAndTell(bench::EpisodeResult& result, const scenarios::Scenario& scenario,
                 const DataPaths& paths, const std::string& out, bool as_json);

}  // namespace sidestep::cli
