#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/run_identity.h"
#include "sidestep/bench/run_row.h"

namespace sidestep::bench {

/// The name of what the robot touched first, empty if nothing.
std::string TouchedBy(const record::Recording& recording);

/// How often tracking has noticed what, by the words of its events.
std::map<std::string, int> TrackEventCounts(const record::Recording& recording);

/// The text of result.json (every key is in docs/results.md): outcome, metrics, identity, versions;
/// the whole scenario as run, under "parameters", with the keys of a scenario file; and, under
/// "wall_clock" alone, everything that may differ between equal runs. Numbers that do not apply are
/// null.
/// @param versions of the code and libraries, of the machine's C library variant, ...
std::string ResultJson(const EpisodeResult& result, const scenarios::Scenario& scenario,
                       const RunIdentity& identity,
                       const std::map<std::string, std::string>& versions);

/// What a result.json tells: a run's row, and the run.
struct StoredResult {
  RunRow row;  ///< without factors, trace and command
  std::string scenario;
  std::uint64_t seed = 1;
  /// Of the scenario as run, by their paths in a scenario file, e.g. "planner.epsilon_m": "0.2".
  std::map<std::string, std::string> parameters;
  std::map<std::string, std::string> versions;
};

/// @throws InputError if the file is missing, not JSON, or not a result.
StoredResult ReadResult(const std::string& path);

}  // namespace sidestep::bench
