#include "sidestep/sdf/map/steady_depths.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace sidestep::sdf {
namespace {

constexpr double kMostOff = 4;    // of one depth, in its standard deviations
constexpr double kNewest = 0.3;   // weight of the newest in the drift
constexpr double kMostDrift = 3;  // in the drift's own standard deviations

// Of the drift, where depths are independent and of deviation 1.
const double kDriftDeviation = std::sqrt(kNewest / (2 - kNewest));

}  // namespace

SteadyDepths::SteadyDepths(int most_images) : most_images_(most_images) {
  if (most_images < 1) throw std::invalid_argument("SteadyDepths: averages at least one image");
}

SteadyDepths::Mean SteadyDepths::Take(int ray, double depth_m, double deviation_m) {
  const auto at = static_cast<std::size_t>(ray);
  if (at >= rays_.size()) rays_.resize(at + 1);
  Ray& known = rays_[at];
  const double off_m = depth_m - known.mean.depth_m;
  // The mean errs as well.
  const double off =
      deviation_m > 0 ? off_m / (deviation_m * std::sqrt(1 + 1.0 / std::max(1, known.mean.count)))
                      : 0;
  known.drift += kNewest * (off - known.drift);
  const bool is_steady = known.mean.count > 0 && deviation_m > 0 && std::abs(off) <= kMostOff &&
                         std::abs(known.drift) <= kMostDrift * kDriftDeviation;
  if (!is_steady) {
    const bool jumps = known.mean.count > 0 && !(std::abs(off) <= kMostOff);
    known = {{depth_m, 1, known.mean.has_jumped || jumps}, 0};
    return known.mean;
  }
  known.mean.count = std::min(known.mean.count + 1, most_images_);
  known.mean.depth_m += off_m / known.mean.count;
  return known.mean;
}

}  // namespace sidestep::sdf
