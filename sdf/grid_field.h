#pragma once

#include <memory>

#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// A world that does not move: one signed-distance grid in W, clamped.
class GridField final : public DistanceField {
 public:
  /// @param max_distance_m [m] > 0. @throws std::invalid_argument otherwise, or without a grid.
  GridField(std::shared_ptr<const SdfGrid> grid_W, double max_distance_m);

  DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const override;
  void SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                  DistanceSamples& samples) const override;
  std::unique_ptr<const FieldSlice> At(EpisodeTime t) const override;
  double max_distance_m() const override { return max_distance_m_; }

 private:
  std::shared_ptr<const SdfGrid> grid_W_;
  double max_distance_m_;
};

}  // namespace sidestep::sdf
