#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"
#include "sidestep/core/solid.h"
#include "sidestep/core/time.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/exact_solids.h"

namespace sidestep::sdf {

/// A shape that moves.
struct MovingShape {
  Shape shape;
  std::function<Pose(EpisodeTime)> X_WO;  ///< pure, finite, safe from many threads
};

/// The exact distance to shapes: the least of all, whether they stand still or move. It knows all
/// of space, so every sample is in its grid. Where solids overlap, the depth in the deeper one.
class ShapeField final : public DistanceField {
 public:
  /// @param max_distance_m > 0; may be infinite.
  /// @throws std::invalid_argument for another, or for a moving shape without a pose.
  explicit ShapeField(const StaticSolids& still, std::vector<MovingShape> moving = {},
                      double max_distance_m = std::numeric_limits<double>::infinity());

  /// The distance alone, without its clamp; infinite where there is no solid at all.
  double Distance(const Eigen::Vector3d& p_WQ, EpisodeTime t) const;

  DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const override;
  void SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                  DistanceSamples& samples) const override;
  std::unique_ptr<const FieldSlice> At(EpisodeTime t) const override;
  double max_distance_m() const override { return max_distance_m_; }

 private:
  std::vector<ExactShape> MovedTo(EpisodeTime t) const;

  ExactSolids still_;
  std::vector<MovingShape> moving_;
  double max_distance_m_;
};

}  // namespace sidestep::sdf
