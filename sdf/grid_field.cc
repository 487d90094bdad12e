#include "sdf/grid_field.h"

#include <stdexcept>
#include <utility>

namespace sidestep {

GridField::GridField(std::shared_ptr<const SdfGrid> grid_W, double max_distance_m)
    : grid_W_(std::move(grid_W)), max_distance_m_(max_distance_m) {
  if (!grid_W_ || !(max_distance_m_ > 0)) {
    throw std::invalid_argument("GridField: needs a grid and a clamp > 0");
  }
}

DistanceSample GridField::Sample(const Eigen::Vector3d& p_WQ, EpisodeTime) const {
  const GridSample sample = grid_W_->Sample(p_WQ);
  if (!sample.in_grid || sample.distance_m >= max_distance_m_) {
    return {max_distance_m_, Eigen::Vector3d::Zero(), sample.in_grid};
  }
  return {sample.distance_m, sample.gradient, true};
}

void GridField::SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                           DistanceSamples& samples) const {
  samples.distance_m.resize(p_WQ.cols());
  samples.gradient_W.resize(3, p_WQ.cols());
  samples.num_outside = 0;
  for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
    const DistanceSample sample = Sample(p_WQ.col(s), t);
    samples.distance_m(s) = sample.distance_m;
    samples.gradient_W.col(s) = sample.gradient_W;
    samples.num_outside += sample.in_grid ? 0 : 1;
  }
}

}  // namespace sidestep
