#pragma once

#include <cstdint>
#include <stdexcept>

#include "sidestep/core/time.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// When a sensor of a fixed rate captures: capture k is due at k / rate, rounded up to a tick of
/// the world, so that the world is exactly then what the scan says. Captures that were missed are
/// skipped.
class CaptureClock {
 public:
  /// @throws std::invalid_argument for a rate that is not > 0.
  explicit CaptureClock(double rate_hz) : rate_hz_(rate_hz) {
    if (!(rate_hz > 0)) throw std::invalid_argument("sensor: the rate must be > 0");
  }

  EpisodeTime Next() const { return World::TimeOf(TickOf(next_)); }

  /// Whether a capture is due at this tick; if so, the next one is the first after it.
  bool Take(std::int64_t tick) {
    if (tick < TickOf(next_)) return false;
    while (TickOf(next_) <= tick) ++next_;
    return true;
  }

 private:
  std::int64_t TickOf(std::int64_t k) const {
    return World::TickNotBefore(EpisodeTime(static_cast<double>(k) / rate_hz_));
  }

  double rate_hz_;
  std::int64_t next_ = 0;
};

}  // namespace sidestep::sim
