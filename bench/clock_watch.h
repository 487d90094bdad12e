#pragma once

#include <array>
#include <cstddef>

#include "sidestep/core/time.h"

namespace sidestep::bench {

/// Whether a sensor's clock and ours still agree as they did at first. The least age of the latest
/// scans is what they take at best and the difference of the clocks; one that is only late changes
/// nothing.
class ClockWatch {
 public:
  /// Further than this the clocks have jumped.
  static constexpr double kJump_s = 0.05;

  /// Takes in a scan that was captured, by the sensor's clock, and has come now, by ours.
  /// @return how much older scans are than they were at first [s], less than 0: younger. 0 until
  /// that is known.
  double Observe(EpisodeTime capture, EpisodeTime now);

 private:
  static constexpr std::size_t kScans = 10;  // a third of a second of a camera

  std::array<double, kScans> ages_s_{};  // a ring
  std::size_t count_ = 0;
  double at_first_s_ = 0;
};

}  // namespace sidestep::bench
