#pragma once

#include <Eigen/Core>
#include <memory>

#include "sidestep/core/time.h"
#include "sidestep/sdf/point_block.h"

namespace sidestep::sdf {

/// What a field says of one point.
struct DistanceSample {
  double distance_m = 0;                                 ///< signed; negative inside an obstacle
  Eigen::Vector3d gradient_W = Eigen::Vector3d::Zero();  ///< d distance / d p_WQ
  bool in_grid = true;                                   ///< false: outside what was mapped
};

/// The same of S points at once.
struct DistanceSamples {
  Eigen::VectorXd distance_m;   ///< shape S
  Eigen::Matrix3Xd gradient_W;  ///< 3 x S
  int num_outside = 0;          ///< how many points lay outside what was mapped
};

/// A field at one moment, for those who have many questions about it: what depends on the time
/// alone is worked out once. Immutable; safe from many threads, and never throws.
class FieldSlice {
 public:
  virtual ~FieldSlice() = default;

  /// Fills what the field says of the block's points: to the bit what SampleMany does, distances
  /// whether gradients are asked for or not.
  /// @param block 1 to PointBlock::kSize finite points, padded (see PointBlock::Pad).
  /// @return how many of them lie outside what was mapped.
  virtual int SampleBlock(PointBlock& block) const = 0;
};

/// The signed distance phi(p, t) from a point to the nearest obstacle, as believed for time t.
/// An immutable snapshot: safe from many threads, and never throws.
class DistanceField {
 public:
  virtual ~DistanceField() = default;

  /// Samples the field at point Q and time `t`.
  ///
  /// The value is trilinear between cell centres, so it is continuous, and its gradient is that of
  /// the interpolant: exact, but it jumps at cell faces. Outside the mapped box `in_grid` is false
  /// and the answer is {max_distance_m(), 0}: unknown space does not push. Only a solid
  /// that is known to reach there still does: a moving object, the floor.
  ///
  /// @param p_WQ [m] position of Q in the world frame W, finite.
  /// @param t    time since the episode began, never an offset from "now".
  virtual DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const = 0;

  /// Samples S points at the same time; sizes `samples` as needed. Equal to S single calls, which
  /// is what it does unless a field has a faster way.
  virtual void SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                          DistanceSamples& samples) const;

  /// The field at time `t`. The field must outlive it.
  virtual std::unique_ptr<const FieldSlice> At(EpisodeTime t) const;

  /// No answer is above this [m]; where an answer equals it, its gradient is zero.
  virtual double max_distance_m() const = 0;
};

}  // namespace sidestep::sdf
