#pragma once

#include <string>

#include "sidestep/bench/episode_world.h"
#include "sidestep/cli/data_paths.h"

namespace sidestep::cli {

/// Makes worlds as cli/hardware_world.h does, each with a simulated robot server of its own, in
/// lock-step, on an address of the loopback that is free; the arm stands where the task starts. So
/// what is sent goes through the adapter and the protocol, and nobody has to start anything.
/// @param faults the lines under `faults:` of a faults file. @param lost_share of the packets.
bench::WorldFactory ServedWorlds(const DataPaths& paths, const std::string& faults,
                                 double lost_share);

}  // namespace sidestep::cli
