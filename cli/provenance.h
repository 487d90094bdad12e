#pragma once

#include "sidestep/bench/run_identity.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/record/recording.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Of a run by this program. @throws InputError if a file of the robot cannot be read.
bench::RunIdentity Identify(const scenarios::Scenario& scenario, const DataPaths& paths);

/// Puts the identity and the versions into the header: what makes the recording of an episode the
/// trace that `sidestep run` writes.
void AddProvenance(const bench::RunIdentity& identity, record::Recording& recording);

}  // namespace sidestep::cli
