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
  if (!(deviation_m > 0) || known.mean.count == 0) {
    known.mean = {depth_m, 1, known.mean.has_jumped};
    return known.mean;
  }
  // The mean errs as well.
  const auto off = [&](const Mean& mean) {
    return (depth_m - mean.depth_m) / (deviation_m * std::sqrt(1 + 1.0 / mean.count));
  };
  const double off_mean = off(known.mean);
  known.drift += kNewest * (off_mean - known.drift);
  if (std::abs(off_mean) > kMostOff) {
    if (known.mean.count >= known.before.count) {
      known.before = {known.mean.depth_m, known.mean.count, false};
    }
    const bool is_back = std::abs(off(known.before)) <= kMostOff;
    known.mean = is_back ? known.before : Mean{depth_m, 0, true};
    known.drift = 0;
  } else if (std::abs(known.drift) > kMostDrift * kDriftDeviation) {
    known.mean = {depth_m, 0, known.mean.has_jumped};
    known.drift = 0;
  }
  known.mean.count = std::min(known.mean.count + 1, most_images_);
  known.mean.depth_m += (depth_m - known.mean.depth_m) / known.mean.count;
  return known.mean;
}

}  // namespace sidestep::sdf
