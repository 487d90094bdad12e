#pragma once

#include <unistd.h>

#include <string>

namespace sidestep::hardware {

/// An address of the loopback that no other process of the tests uses: the port is fixed, and all
/// of 127.0.0.0/8 is this machine.
inline std::string OwnLoopback() {
  const auto pid = static_cast<unsigned>(getpid());
  return "127." + std::to_string(1 + (pid >> 16 & 0x3f)) + "." + std::to_string(pid >> 8 & 0xff) +
         "." + std::to_string(pid & 0xff);
}

}  // namespace sidestep::hardware
