#pragma once

#include <cstddef>

namespace sidestep::sdf {

/// Up to kSize points and what a field says of them, as a structure of arrays.
struct alignas(64) PointBlock {
  static constexpr std::size_t kSize = 64;
  static constexpr std::size_t kVector = 8;  ///< so many points, at most, are worked on together

  double x[kSize], y[kSize], z[kSize];
  double distance_m[kSize];
  double gradient_x[kSize], gradient_y[kSize], gradient_z[kSize];
  std::size_t count = 0;       // last: each array begins at a cache line
  bool with_gradients = true;  ///< asked for; if not, what stands there means nothing

  /// Repeats the last of `count` >= 1 points up to the next multiple of kVector. Those who answer
  /// work on whole vectors.
  void Pad() {
    for (std::size_t n = count; n % kVector != 0; ++n) {
      x[n] = x[count - 1];
      y[n] = y[count - 1];
      z[n] = z[count - 1];
    }
  }
};

}  // namespace sidestep::sdf
