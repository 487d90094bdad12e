#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/core/time.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/map/sdf_grid.h"
#include "sidestep/sdf/placed_composite.h"

namespace sidestep::sdf {

/// A rigid thing that moves: the field of its shape in its own frame O, and where O is at a time.
struct MovingField {
  std::shared_ptr<const SdfGrid> field_O;
  std::function<Pose(EpisodeTime)> X_WO;  ///< pure, finite, safe from many threads
  /// By how much the thing is taken to be thicker all round [m], from 0 to max_growth_m, where it
  /// may be elsewhere than at X_WO; as pure as X_WO. Empty: never.
  std::function<double(EpisodeTime)> growth_m = {};
  double max_growth_m = 0;
};

/// A world with moving things in it, composed when it is asked:
///   phi(p, t) = min(static(p), exact(p), field_j(X_OW_j(t) p) - growth_j(t), max_distance_m),
/// with the gradient of whichever is smallest, in W. Of what stands still, static(p) is the part
/// that a map holds as cells, exact(p) the part that is known by its shape, as the floor is. It
/// costs no work and no memory for each time it is asked about, and rounds no position to cells.
///
/// An object's field must reach max_distance_m + max_growth_m wherever its grid ends
/// (MakeObjectField sees to that). Then the composite is continuous, and in free space within
/// max_distance_m it is the distance to the nearest of all things; inside things that touch or
/// overlap it may underestimate the depth.
///
/// Where the static grid ends, exact solids and objects still count: the answer is that of those
/// that reach there, max_distance_m if none does; `in_grid` is false either way, because what else
/// is there is not known.
///
/// Source: the composite min over objects is Finean, Merkt & Havoutis (ICAPS 2021), who compute it
/// for a grid and a step at a time (sdf/dense_composite.h).
class CompositeField final : public DistanceField {
 public:
  /// @throws std::invalid_argument without a static grid, an object's field or pose, for a clamp
  /// that is not > 0, or for an object whose field is below the clamp at its grid's border.
  CompositeField(std::shared_ptr<const SdfGrid> static_W, std::vector<MovingField> objects,
                 double max_distance_m, const StaticSolids& exact = {});

  DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const override;
  void SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                  DistanceSamples& samples) const override;
  double max_distance_m() const override { return max_distance_m_; }

  /// The same at one time: asks each object for its pose once. This field must outlive it.
  PlacedComposite PlacedAt(EpisodeTime t) const;
  std::unique_ptr<const FieldSlice> At(EpisodeTime t) const override;

 private:
  std::shared_ptr<const SdfGrid> static_W_;
  std::vector<MovingField> objects_;
  std::vector<FieldBound> bounds_;  // of the objects' fields
  double max_distance_m_;
  ExactSolids exact_;
};

}  // namespace sidestep::sdf
