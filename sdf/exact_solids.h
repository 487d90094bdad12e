#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"
#include "sidestep/core/solid.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/field_kernels.h"

namespace sidestep::sdf {

/// A shape at a pose, ready to be asked.
class ExactShape {
 public:
  ExactShape(const Shape& shape, const Pose& X_WO);

  double Distance(const Eigen::Vector3d& p_WQ) const {
    return SignedDistance(shape_, X_OW_ * p_WQ);
  }
  /// Makes the sample that of this shape, where it is nearer.
  void Lower(const Eigen::Vector3d& p_WQ, DistanceSample& sample) const;
  /// False only where no point of the box is nearer to the shape than `distance_m`.
  bool CanBeNearer(const Eigen::Vector3d& low_W, const Eigen::Vector3d& high_W,
                   double distance_m) const;

 private:
  Shape shape_;
  Pose X_WO_, X_OW_;
  Eigen::Vector3d low_W_, high_W_;  // of the box around it
};

/// Solids at rest by their closed forms: what a field knows better than by cells.
class ExactSolids {
 public:
  ExactSolids() = default;
  explicit ExactSolids(const StaticSolids& solids);

  /// The least distance; infinite without a solid.
  double Distance(const Eigen::Vector3d& p_WQ) const;
  /// Makes the sample that of a solid, where that is nearer.
  void Lower(const Eigen::Vector3d& p_WQ, DistanceSample& sample) const {
    for (const HalfSpace& half_space : half_spaces_) {
      const double distance_m = SignedDistance(half_space, p_WQ);
      if (!(distance_m < sample.distance_m)) continue;
      sample.distance_m = distance_m;
      sample.gradient_W = half_space.normal_W;
    }
    if (!shapes_.empty()) LowerByShapes(p_WQ, sample);
  }
  /// The same for a block of points, to the last bit.
  void Lower(field_kernels::Block& block) const;

 private:
  void LowerByShapes(const Eigen::Vector3d& p_WQ, DistanceSample& sample) const;

  std::vector<HalfSpace> half_spaces_;
  std::vector<ExactShape> shapes_;
};

}  // namespace sidestep::sdf
