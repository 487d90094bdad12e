#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/aligned_vector.h"

namespace sidestep::sdf {

/// What an SdfGrid says of one point, in the grid's own frame.
struct GridSample {
  double distance_m = 0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< d distance / d p
  bool in_grid = false;                                ///< false: the other two mean nothing
};

/// Signed distances at the cell centres of a grid, and between them by trilinear interpolation.
///
/// The values are floats: 4 cm cells are then exact to 0.2 micrometres, and they are what the
/// authors of Finean et al. (ICAPS 2021) stored. Interpolation is in double.
class SdfGrid {
 public:
  /// @param distance_m [m] one finite value a cell, in the order of GridSpec::Index.
  /// @throws std::invalid_argument for a bad spec or another number of values.
  SdfGrid(const GridSpec& spec, AlignedVector<float> distance_m);

  /// The interpolated distance and the exact gradient of that interpolant.
  ///
  /// The domain reaches from the first to the last cell centre of each axis, both included; outside
  /// it `in_grid` is false. At a cell centre the gradient is that of the cell above, on the upper
  /// face of the domain that of the last cell. Along an axis of one cell the gradient is zero.
  GridSample Sample(const Eigen::Vector3d& p) const {
    if (!Covers(p)) return {};
    return Interpolate(p);
  }

  /// Whether p lies in the domain of Sample.
  bool Covers(const Eigen::Vector3d& p) const {
    return (p.array() >= spec_.first_center_m.array()).all() &&
           (p.array() <= last_center_m_.array()).all();
  }

  /// The value at the centre of a cell of the grid [m].
  float At(int i, int j, int k) const { return distance_m_[spec_.Index(i, j, k)]; }

  const GridSpec& spec() const { return spec_; }
  const AlignedVector<float>& distance_m() const { return distance_m_; }
  const Eigen::Vector3d& last_center_m() const { return last_center_m_; }
  /// 1 / cell_m, rounded: what positions and gradients are multiplied by.
  double cells_per_m() const { return cells_per_m_; }

 private:
  GridSample Interpolate(const Eigen::Vector3d& p) const;

  GridSpec spec_;
  Eigen::Vector3d last_center_m_;
  double cells_per_m_;
  AlignedVector<float> distance_m_;
};

inline GridSample SdfGrid::Interpolate(const Eigen::Vector3d& p) const {
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
    const double u = (p(a) - spec_.first_center_m(a)) * cells_per_m_;
    // Rounding may carry a point that Covers() accepts past the last sample: hence the clamps.
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

  // Collapse x, then y, then z; the differences of each stage are the gradient's parts. The order
  // of the operations is that of field_kernels.cc.
  const double dx00 = d100 - d000, dx10 = d110 - d010, dx01 = d101 - d001, dx11 = d111 - d011;
  const double d00 = d000 + f[0] * dx00, d10 = d010 + f[0] * dx10;
  const double d01 = d001 + f[0] * dx01, d11 = d011 + f[0] * dx11;
  const double dy0 = d10 - d00, dy1 = d11 - d01;
  const double d0 = d00 + f[1] * dy0, d1 = d01 + f[1] * dy1;
  const double dx0 = dx00 + f[1] * (dx10 - dx00), dx1 = dx01 + f[1] * (dx11 - dx01);

  GridSample sample;
  sample.in_grid = true;
  sample.distance_m = d0 + f[2] * (d1 - d0);
  sample.gradient = {(dx0 + f[2] * (dx1 - dx0)) * cells_per_m_,
                     (dy0 + f[2] * (dy1 - dy0)) * cells_per_m_, (d1 - d0) * cells_per_m_};
  return sample;
}

}  // namespace sidestep::sdf
