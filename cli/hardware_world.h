#pragma once

#include <functional>
#include <string>

#include "sidestep/bench/episode_world.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/hardware/panda_robot.h"

namespace sidestep::cli {

/// Makes worlds in which a Panda at the end of a wire stands, and the scenario's obstacles move as
/// they are prescribed ("virtual obstacles"): its sensor sees those, and nobody knows whether the
/// arm touches anything real. Each world connects anew.
/// @param on_connected is shown the robot; it may be told to stop as long as the world lives.
/// The factory throws InputError if nobody answers, or the robot is not where the task starts.
bench::WorldFactory HardwareWorlds(const DataPaths& paths, const std::string& address,
                                   const hardware::PandaOptions& options,
                                   const std::function<void(hardware::PandaRobot*)>& on_connected);

}  // namespace sidestep::cli
