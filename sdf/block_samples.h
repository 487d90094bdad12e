#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/field_kernels.h"

namespace sidestep::sdf {

/// One point of a block, for what looks at them one by one.
inline Eigen::Vector3d PointOf(const field_kernels::Block& block, std::size_t n) {
  return {block.x[n], block.y[n], block.z[n]};
}
inline DistanceSample SampleOf(const field_kernels::Block& block, std::size_t n) {
  DistanceSample sample{block.distance_m[n], Eigen::Vector3d::Zero(), true};
  if (block.with_gradients) {
    sample.gradient_W << block.gradient_x[n], block.gradient_y[n], block.gradient_z[n];
  }
  return sample;
}
inline void SetSample(const DistanceSample& sample, std::size_t n, field_kernels::Block& block) {
  block.distance_m[n] = sample.distance_m;
  block.gradient_x[n] = sample.gradient_W.x();
  block.gradient_y[n] = sample.gradient_W.y();
  block.gradient_z[n] = sample.gradient_W.z();
}

/// The box around a block's points and the largest distance said of them so far: a thing that is
/// no nearer to the box lowers none of them.
struct BlockBounds {
  Eigen::Vector3d low, high;
  double farthest_m = 0;
};
inline BlockBounds BoundsOf(const field_kernels::Block& block) {
  BlockBounds bounds{PointOf(block, 0), PointOf(block, 0), block.distance_m[0]};
  for (std::size_t n = 1; n < block.count; ++n) {
    bounds.low = bounds.low.cwiseMin(PointOf(block, n));
    bounds.high = bounds.high.cwiseMax(PointOf(block, n));
    bounds.farthest_m = std::max(bounds.farthest_m, block.distance_m[n]);
  }
  return bounds;
}

}  // namespace sidestep::sdf
