#pragma once

#include <map>
#include <string>

#include "sidestep/bench/run_identity.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/record/recording.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Of a run by this program. @throws InputError if a file of the robot cannot be read.
bench::RunIdentity Identify(const scenarios::Scenario& scenario, const DataPaths& paths);

/// Its identity and the versions, as they stand in the header of a trace.
std::map<std::string, std::string> Provenance(const bench::RunIdentity& identity);
/// ... and the identity that a header tells. @throws std::out_of_range if it tells none.
bench::RunIdentity IdentityIn(const std::map<std::string, std::string>& header);
/// ... and the versions.
std::map<std::string, std::string> VersionsIn(const std::map<std::string, std::string>& header);

/// Puts the identity and the versions into the header: what makes the recording of an episode the
/// trace that `sidestep run` writes.
void AddProvenance(const bench::RunIdentity& identity, record::Recording& recording);

}  // namespace sidestep::cli
