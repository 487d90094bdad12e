#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace sidestep {

/// What a program left when it ended.
struct Finished {
  int exit_code = -1;  ///< -1: ended by a signal
  int signal = 0;      ///< which
  std::string out;     ///< standard output
  std::string err;     ///< standard error
};

/// A program that runs meanwhile.
class Running {
 public:
  /// Starts it as RunProgram does. @param input to be its standard input; -1: nothing to read.
  explicit Running(const std::vector<std::string>& command,
                   const std::vector<std::string>& environment = {},
                   const std::string& working_directory = "", int input = -1);
  ~Running();  ///< kills it
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void Signal(int signal) const;
  /// What it has printed until now.
  std::string out() const;
  /// Whether it has printed this, or does within half a minute, unless it ends.
  bool Prints(const std::string& text);
  /// Waits for its end.
  Finished Finish();

 private:
  bool HasEnded();

  std::unique_ptr<TemporaryFolder> folder_;
  std::string name_;
  int child_ = -1;
  std::optional<int> status_;
};

/// Runs a program to its end. `environment` is added to this process's own, "NAME=value".
/// @throws std::runtime_error if it cannot be started.
Finished RunProgram(const std::vector<std::string>& command,
                    const std::vector<std::string>& environment = {},
                    const std::string& working_directory = "");

}  // namespace sidestep
