#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/grid.h"

namespace sidestep {

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
  SdfGrid(const GridSpec& spec, std::vector<float> distance_m);

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
  const std::vector<float>& distance_m() const { return distance_m_; }
  const Eigen::Vector3d& last_center_m() const { return last_center_m_; }

 private:
  GridSample Interpolate(const Eigen::Vector3d& p) const;

  GridSpec spec_;
  Eigen::Vector3d last_center_m_;
  std::vector<float> distance_m_;
};

}  // namespace sidestep
