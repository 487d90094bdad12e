#include "sdf/map/sdf_grid.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sidestep {

SdfGrid::SdfGrid(const GridSpec& spec, std::vector<float> distance_m)
    : spec_(spec), distance_m_(std::move(distance_m)) {
  CheckGridSpec(spec_);
  if (distance_m_.size() != spec_.num_cells()) {
    throw std::invalid_argument("SdfGrid: needs one value a cell");
  }
  last_center_m_ = spec_.Center(spec_.size[0] - 1, spec_.size[1] - 1, spec_.size[2] - 1);
}

GridSample SdfGrid::Interpolate(const Eigen::Vector3d& p) const {
  // Along each axis: the lower of the two samples around p, the step in memory to the upper one,
  // and how far p lies between them. On the upper face the last cell answers with fraction 1. One
  // cell alone has no upper sample: a step of 0 makes both the same.
  const std::size_t stride[3] = {
      1, static_cast<std::size_t>(spec_.size[0]),
      static_cast<std::size_t>(spec_.size[0]) * static_cast<std::size_t>(spec_.size[1])};
  std::size_t base = 0;
  std::size_t step[3];
  double f[3];
  for (int a = 0; a < 3; ++a) {
    const int last = spec_.size[static_cast<std::size_t>(a)] - 1;
    // Rounding may carry a point that Covers() accepts a few ulps past the ends: hence the clamps.
    const double u = std::max((p(a) - spec_.first_center_m(a)) / spec_.cell_m, 0.0);
    const int lower = std::min(static_cast<int>(u), std::max(last - 1, 0));
    f[a] = last > 0 ? std::min(u - lower, 1.0) : 0.0;
    step[a] = last > 0 ? stride[a] : 0;
    base += static_cast<std::size_t>(lower) * stride[a];
  }

  const float* d = distance_m_.data() + base;
  const double d000 = d[0];
  const double d100 = d[step[0]];
  const double d010 = d[step[1]];
  const double d110 = d[step[1] + step[0]];
  const double d001 = d[step[2]];
  const double d101 = d[step[2] + step[0]];
  const double d011 = d[step[2] + step[1]];
  const double d111 = d[step[2] + step[1] + step[0]];

  // Collapse x, then y, then z; the differences of each stage are the gradient's parts.
  const double dx00 = d100 - d000, dx10 = d110 - d010, dx01 = d101 - d001, dx11 = d111 - d011;
  const double d00 = d000 + f[0] * dx00, d10 = d010 + f[0] * dx10;
  const double d01 = d001 + f[0] * dx01, d11 = d011 + f[0] * dx11;
  const double dy0 = d10 - d00, dy1 = d11 - d01;
  const double d0 = d00 + f[1] * dy0, d1 = d01 + f[1] * dy1;
  const double dx0 = dx00 + f[1] * (dx10 - dx00), dx1 = dx01 + f[1] * (dx11 - dx01);

  GridSample sample;
  sample.in_grid = true;
  sample.distance_m = d0 + f[2] * (d1 - d0);
  sample.gradient =
      Eigen::Vector3d(dx0 + f[2] * (dx1 - dx0), dy0 + f[2] * (dy1 - dy0), d1 - d0) / spec_.cell_m;
  return sample;
}

}  // namespace sidestep
