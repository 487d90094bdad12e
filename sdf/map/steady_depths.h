#pragma once

#include <vector>

namespace sidestep::sdf {

/// What each ray of a camera that stands still measures, averaged for as long as it stays the
/// same: the temporal filter that depth cameras have. Noise goes with the root of the number of
/// images; what changes is taken as it is measured.
///
/// A ray starts afresh where one depth is more than 4 standard deviations off the mean, or several
/// in a row are off to the same side: an average of the newest that weighs them by 0.3, 0.21, ...
/// must be within 3 of its own standard deviations. So the mean of what creeps along a ray is
/// never more than some 1.5 standard deviations of a single depth behind.
/// What it saw for longest is kept: a wall before which something has passed is known again.
/// Source: the exponentially weighted control chart of S. W. Roberts (Technometrics 1, 1959).
class SteadyDepths {
 public:
  struct Mean {
    double depth_m = 0;
    int count = 0;            ///< of how many images; not above the most
    bool has_jumped = false;  ///< away from what the ray has seen for longest
  };

  /// @param most_images the newest weighs at least 1 / most_images; 1: nothing is averaged.
  /// @throws std::invalid_argument if most_images < 1.
  explicit SteadyDepths(int most_images);

  /// Takes in what a ray measured.
  /// @param ray which it is, from 0.
  /// @param deviation_m of that depth; 0: it is exact, and the mean is it.
  Mean Take(int ray, double depth_m, double deviation_m);

 private:
  struct Ray {
    Mean mean;
    Mean before;       // what it saw for longest, before the last jump
    double drift = 0;  // of the newest depths from the mean, in standard deviations
  };

  int most_images_;
  std::vector<Ray> rays_;
};

}  // namespace sidestep::sdf
