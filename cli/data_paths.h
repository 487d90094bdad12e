#pragma once

#include <string>
#include <vector>

#include "sidestep/core/model_folders.h"

namespace sidestep::cli {

/// The folders of robots and scenarios.
struct DataPaths {
  std::string models;  ///< that come with Sidestep
  std::string scenarios;
  std::vector<std::string> more_models = {};

  /// Those of more_models first.
  ModelFolders all_models() const;
};

/// The first of these that holds `models/` and `scenarios/`: $SIDESTEP_DATA_DIR (which must, if it
/// is set), ../share/sidestep beside the running program, the source tree it was built from.
/// @param more_models further folders of robots, which --models named.
/// @throws InputError if there is none, or one of `more_models` is no folder.
DataPaths FindDataPaths(const std::vector<std::string>& more_models = {});

/// A scenario's file: `scenario` itself if it looks like a path (has a / or ends in .yaml), else
/// the shipped scenario of that name. @throws InputError for an unknown name, listing the known.
std::string FindScenario(const std::string& scenario, const DataPaths& paths);

}  // namespace sidestep::cli
