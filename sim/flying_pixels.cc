#include "sidestep/sim/flying_pixels.h"

#include <algorithm>
#include <cstddef>

namespace sidestep::sim {

std::vector<bool> FindFlyingPixels(const DepthImage& image, double edge_m) {
  std::vector<bool> flies(image.depths_m.size(), false);
  if (!(edge_m > 0)) return flies;
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  const std::vector<double>& z = image.depths_m;
  const auto is_between = [&](std::size_t n, std::size_t step) {
    const auto [near_m, far_m] = std::minmax(z[n - step], z[n + step]);
    return z[n] - near_m > edge_m && far_m - z[n] > edge_m;
  };
  for (std::size_t v = 0; v < height; ++v) {
    for (std::size_t u = 0; u < width; ++u) {
      const std::size_t n = v * width + u;
      const bool in_row = u > 0 && u + 1 < width && is_between(n, 1);
      const bool in_column = v > 0 && v + 1 < height && is_between(n, width);
      flies[n] = in_row || in_column;
    }
  }
  return flies;
}

}  // namespace sidestep::sim
