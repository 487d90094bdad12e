#pragma once

#include <string>

#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// What decides the bits of a run on machines of one kind. Equal identities mean equal runs; where
/// one differs, it says what was changed.
struct RunIdentity {
  std::string scenario;  ///< fingerprint of the resolved scenario's own text: no comment, no order
  std::string models;    ///< of every file in the folders of its robot and of its appearances
  std::string build;     ///< the linker's id of the program
  std::string method;    ///< what else is done with the scenario; empty: an episode is run
};

/// Of an episode. @throws InputError if a file cannot be read.
RunIdentity IdentifyRun(const scenarios::Scenario& scenario, const ModelFolders& models,
                        const std::string& build);

/// One word for it all.
std::string RunId(const RunIdentity& identity);

}  // namespace sidestep::bench
