#pragma once

#include <chrono>

namespace sidestep {

/// Measures how long stages take on the wall clock, for reports. Nothing may depend on it.
class Stopwatch {
 public:
  /// Seconds since the last call, or since it was made.
  double Lap() {
    const Clock::time_point now = Clock::now();
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return elapsed_s;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace sidestep
