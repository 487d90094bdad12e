#pragma once

#include <string>

#include "sidestep/bench/run_row.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/wiring.h"

namespace sidestep::cli {

/// Stands in the place of a kind of knowledge: who knows all and has time.
inline constexpr const char* kSearch = "search";
/// The factor that is no key: the speed of every moving obstacle.
inline constexpr const char* kSpeedFactor = "speed_m_s";

/// One run among many. Factors are keys of --set, several that vary together (cli/varied_keys.h),
/// kSpeedFactor, and `knowledge`, `predictor` and `seed`, which stand for the flags of `sidestep
/// run`.
/// @param robots of the other runs, to which its own is added.
/// @throws InputError if the combination makes no sense.
Problem LoadCase(const std::string& scenario, const bench::Factors& factors, const DataPaths& paths,
                 CheckedRobots* robots);

/// What LoadCase complains of, by the names of factors instead of the flags of `sidestep run`:
/// `knowledge: ...`, `planner.epsilon_m: ...`. Anything else as it is.
std::string FaultByFactor(const std::string& fault);

bool IsSearch(const bench::Factors& factors);

/// What runs one case alone, to the same trace; empty for a search.
std::string RunCommandOf(const std::string& scenario, const bench::Factors& factors);

}  // namespace sidestep::cli
