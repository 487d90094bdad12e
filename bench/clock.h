#pragma once

#include <memory>

#include "sidestep/core/time.h"

namespace sidestep::bench {

/// What an episode's time goes by.
class Clock {
 public:
  virtual ~Clock() = default;

  /// Returns when `t` has come, or as soon after as it can be, and tells the time then: never less
  /// than `t`, and never less than it told before.
  virtual EpisodeTime WaitUntil(EpisodeTime t) = 0;
};

/// Time passes only in what is simulated: `t` comes at once, and a run gives the same bits again.
std::unique_ptr<Clock> MakeVirtualClock();

/// Real time, monotonic, since the first call.
std::unique_ptr<Clock> MakeWallClock();

}  // namespace sidestep::bench
