#pragma once

#include <CLI/CLI.hpp>

namespace sidestep::cli {

/// `-j, --jobs`: how many episodes may run at a time. Once the line is parsed, `jobs` is a number
/// from 1 to 256: what the user asked for, else that of the processors. Both references must live
/// as long as the command.
void AddJobsOption(CLI::App& command, int& jobs);

}  // namespace sidestep::cli
