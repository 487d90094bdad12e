#include "sidestep/sdf/grid_field.h"

#include <span>
#include <stdexcept>
#include <utility>

#include "sidestep/sdf/placed_composite.h"

namespace sidestep::sdf {

GridField::GridField(std::shared_ptr<const SdfGrid> grid_W, double max_distance_m)
    : grid_W_(std::move(grid_W)), max_distance_m_(max_distance_m) {
  if (!grid_W_ || !(max_distance_m_ > 0)) {
    throw std::invalid_argument("GridField: needs a grid and a clamp > 0");
  }
}

DistanceSample GridField::Sample(const Eigen::Vector3d& p_WQ, EpisodeTime) const {
  return PlacedComposite(*grid_W_, {}, max_distance_m_).Sample(p_WQ);
}

void GridField::SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime,
                           DistanceSamples& samples) const {
  PlacedComposite(*grid_W_, {}, max_distance_m_).SampleMany(p_WQ, samples);
}

std::unique_ptr<const FieldSlice> GridField::At(EpisodeTime) const {
  return std::make_unique<PlacedComposite>(*grid_W_, std::span<const PlacedObject>(),
                                           max_distance_m_);
}

}  // namespace sidestep::sdf
