#include "sidestep/sdf/exact_solids.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "sidestep/core/shape_gradient.h"
#include "sidestep/sdf/block_samples.h"

namespace sidestep::sdf {
namespace {

constexpr double kShapeRounding_m = 1e-9;  // what bounds are wider than their shapes

}  // namespace

ExactShape::ExactShape(const Shape& shape, const Pose& X_WO)
    : shape_(shape), X_WO_(X_WO), X_OW_(X_WO.Inverse()) {
  const Eigen::Vector3d half_W =
      X_WO.rotation().toRotationMatrix().cwiseAbs() * HalfExtents(shape) +
      Eigen::Vector3d::Constant(kShapeRounding_m);
  low_W_ = X_WO.translation() - half_W;
  high_W_ = X_WO.translation() + half_W;
}

void ExactShape::Lower(const Eigen::Vector3d& p_WQ, DistanceSample& sample) const {
  if (!CanBeNearer(p_WQ, p_WQ, sample.distance_m)) return;
  const Eigen::Vector3d p_OQ = X_OW_ * p_WQ;
  const double distance_m = SignedDistance(shape_, p_OQ);
  if (!(distance_m < sample.distance_m)) return;
  sample.distance_m = distance_m;
  sample.gradient_W = X_WO_.Rotate(DistanceGradient(shape_, p_OQ));
}

bool ExactShape::CanBeNearer(const Eigen::Vector3d& low_W, const Eigen::Vector3d& high_W,
                             double distance_m) const {
  const double reach_m = std::max(distance_m, 0.0);
  return (low_W_ - high_W).cwiseMax(low_W - high_W_).cwiseMax(0.0).squaredNorm() <=
         reach_m * reach_m;
}

ExactSolids::ExactSolids(const StaticSolids& solids) : half_spaces_(solids.half_spaces) {
  for (const PlacedShape& placed : solids.shapes) shapes_.emplace_back(placed.shape, placed.X_WO);
}

double ExactSolids::Distance(const Eigen::Vector3d& p_WQ) const {
  double least_m = std::numeric_limits<double>::infinity();
  for (const HalfSpace& half_space : half_spaces_) {
    least_m = std::min(least_m, SignedDistance(half_space, p_WQ));
  }
  for (const ExactShape& shape : shapes_) least_m = std::min(least_m, shape.Distance(p_WQ));
  return least_m;
}

void ExactSolids::LowerByShapes(const Eigen::Vector3d& p_WQ, DistanceSample& sample) const {
  for (const ExactShape& shape : shapes_) shape.Lower(p_WQ, sample);
}

void ExactSolids::Lower(field_kernels::Block& block) const {
  for (const HalfSpace& half_space : half_spaces_) {
    field_kernels::LowerByHalfSpace(half_space, block);
  }
  if (shapes_.empty()) return;
  const BlockBounds bounds = BoundsOf(block);
  for (const ExactShape& shape : shapes_) {
    if (!shape.CanBeNearer(bounds.low, bounds.high, bounds.farthest_m)) continue;
    for (std::size_t n = 0; n < block.count; ++n) {
      DistanceSample sample = SampleOf(block, n);
      shape.Lower(PointOf(block, n), sample);
      SetSample(sample, n, block);
    }
  }
}

}  // namespace sidestep::sdf
