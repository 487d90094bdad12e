#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace sidestep {

/// What a program left when it ended.
struct Finished {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out;     ///< standard output
  std::string err;     ///< standard error
};

/// A program that runs meanwhile; what it says goes to files, so that nothing waits for a reader.
class RunningProgram {
 public:
  /// As RunProgram.
  explicit RunningProgram(const std::vector<std::string>& command,
                          const std::vector<std::string>& environment = {},
                          const std::string& working_directory = "");
  /// Kills it, if it still runs.
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void Signal(int number) const;
  /// What it has said so far on its standard output.
  std::string OutSoFar() const;
  /// Waits for its end. Call once. @throws std::runtime_error if it could not be started.
  Finished Wait();

 private:
  const TemporaryFolder folder_;
  const std::string name_;
  pid_t child_ = -1;
};

/// Runs a program to its end. `environment` is added to this process's own, "NAME=value".
/// @throws std::runtime_error if it cannot be started.
Finished RunProgram(const std::vector<std::string>& command,
                    const std::vector<std::string>& environment = {},
                    const std::string& working_directory = "");

}  // namespace sidestep
