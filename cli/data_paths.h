#pragma once

#include <string>

namespace sidestep::cli {

/// The folders of robots and scenarios.
struct DataPaths {
  std::string models;
  std::string scenarios;
};

/// The first of these that holds `models/` and `scenarios/`: $SIDESTEP_DATA_DIR (which must, if it
/// is set), ../share/sidestep beside the running program, the source tree it was built from.
/// @throws InputError if there is none.
DataPaths FindDataPaths();

/// A scenario's file: `scenario` itself if it looks like a path (has a / or ends in .yaml), else
/// the shipped scenario of that name. @throws InputError for an unknown name, listing the known.
std::string FindScenario(const std::string& scenario, const DataPaths& paths);

}  // namespace sidestep::cli
