#pragma once

#include <string>

#include "sidestep/bench/run_row.h"
#include "sidestep/cli/checked_robots.h"
#include "sidestep/cli/data_paths.h"

namespace sidestep::cli {

/// Runs a case (cli/run_case.h) to its row, whose factors are not filled; one that is refused is a
/// row too.
/// @param guesses of a search. @param robots of the other runs, to which its own is added.
/// @param make_world SimulatedWorlds(paths), of the other runs too.
bench::RecordedRun RunCase(const std::string& scenario, const bench::Factors& factors, int guesses,
                           const DataPaths& paths, const bench::WorldFactory& make_world,
                           CheckedRobots* robots);

}  // namespace sidestep::cli
