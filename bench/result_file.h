#pragma once

#include <map>
#include <string>

#include "sidestep/bench/episode.h"

namespace sidestep::bench {

/// The text of result.json: outcome, metrics, scenario, versions; and, under "wall_clock" alone,
/// everything that may differ between equal runs. Numbers that do not apply are null.
/// @param versions of the code and libraries, of the machine's C library variant, ...
std::string ResultJson(const EpisodeResult& result, const scenarios::Scenario& scenario,
                       const std::map<std::string, std::string>& versions);

/// What a comparison table needs of a result.json.
struct ResultSummary {
  std::string scenario, knowledge;
  Outcome outcome = Outcome::kAborted;
  std::map<std::string, double> metrics;  ///< NaN where null
  double cycle_p50_ms = 0;
};

/// @throws InputError if the file is missing, not JSON, or not a result.
ResultSummary ReadResult(const std::string& path);

}  // namespace sidestep::bench
