#pragma once

#include <memory>
#include <string>

#include "sidestep/hardware/fci_driver.h"

namespace sidestep::hardware {

struct LibfrankaOptions {
  /// Refuses to move unless the thread runs with SCHED_FIFO on a kernel that says it is real-time.
  bool enforce_realtime = true;
  /// Libfranka's own limiter and low-pass filter. On a real robot they make up for a signal that is
  /// nearly right; to see whether a signal is right, leave both off.
  bool limit_rate = true;
  double cutoff_hz = 100;  ///< 1000: no filter
};

/// Whether this build has libfranka.
bool HasLibfranka();

/// Drives a Panda by libfranka 0.9. @throws FciError kNetwork, kVersion; std::invalid_argument in a
/// build without libfranka.
std::unique_ptr<FciDriver> MakeLibfrankaDriver(const std::string& address,
                                               const LibfrankaOptions& options);

}  // namespace sidestep::hardware
