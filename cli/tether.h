#pragma once

#include <sys/types.h>

#include <string>

namespace sidestep::cli {

/// What a robot that moves on hardware hangs on: the program that started this one, and standard
/// input where that was open then, a terminal or a pipe. When one of them has gone, nobody attends
/// the robot any more.
class Tether {
 public:
  /// Looks at both as they are now.
  Tether();

  /// Which of them has gone; empty: neither. Never waits.
  std::string WhatIsGone() const;

 private:
  pid_t parent_;
  bool has_input_;
};

}  // namespace sidestep::cli
