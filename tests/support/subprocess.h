#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// What a program left when it ended.
struct Finished {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;     ///< standard output
  std::string err;     ///< standard error
};

/// Runs a program to its end. `environment` is added to this process's own, "NAME=value".
/// @throws std::runtime_error if it cannot be started.
Finished RunProgram(const std::vector<std::string>& command,
                    const std::vector<std::string>& environment = {},
                    const std::string& working_directory = "");

}  // namespace sidestep
