#include "sidestep/sdf/tracking/tracked_object.h"

#include <algorithm>
#include <cmath>

namespace sidestep::sdf {

const Sighting& SightingBefore(const std::vector<Sighting>& history, HorizonOffset baseline) {
  const Sighting& latest = history.back();
  const auto off_baseline = [&](const Sighting& sighting) {
    return std::abs((latest.t - sighting.t).seconds() - baseline.seconds());
  };
  return *std::min_element(history.begin(), history.end() - 1, [&](const auto& a, const auto& b) {
    return off_baseline(a) < off_baseline(b);
  });
}

Eigen::Vector3d MeanVelocity(const std::vector<Sighting>& history, HorizonOffset baseline) {
  const Sighting& latest = history.back();
  const Sighting& earlier = SightingBefore(history, baseline);
  const double elapsed_s = (latest.t - earlier.t).seconds();
  if (!(elapsed_s > 0)) return Eigen::Vector3d::Zero();
  return (latest.p_WO - earlier.p_WO) / elapsed_s;
}

}  // namespace sidestep::sdf
