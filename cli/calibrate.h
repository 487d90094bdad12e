#pragma once

#include "sidestep/cli/command.h"

namespace sidestep::cli {

/// Adds `calibrate` to the verb `hardware`.
void AddCalibrate(CLI::App& hardware, CommandLine& line);

}  // namespace sidestep::cli
