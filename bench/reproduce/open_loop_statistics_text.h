#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_statistics.h"

namespace sidestep::bench {

/// A JSON array with an entry a filter and every figure under its name; what does not apply is
/// null.
std::string ToJson(const std::vector<OpenLoopStatistics>& statistics);

/// The chief figures in a few lines, for a terminal.
std::string Describe(const OpenLoopStatistics& statistics);

}  // namespace sidestep::bench
