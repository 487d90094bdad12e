#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/sdf/aligned_vector.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// The composite field as a grid, for one time: a copy of the static grid, lowered by each object's
/// field where that reaches, with the object moved to the nearest whole cell. It is what the
/// authors compute for each predicted step; here it serves comparison and export, since
/// CompositeField is cheaper and rounds nothing. Not clamped, without growth and
/// without exact solids.
///
/// Source: Finean, Merkt & Havoutis (ICAPS 2021), algorithm 2.
///
/// @param distance_m [m] receives one value a cell.
/// @throws std::invalid_argument for an object with another cell edge, or turned against W, or a
/// `distance_m` of another size.
void ComposeDense(const SdfGrid& static_W, const std::vector<MovingField>& objects, EpisodeTime t,
                  std::span<float> distance_m);
SdfGrid ComposeDense(const SdfGrid& static_W, const std::vector<MovingField>& objects,
                     EpisodeTime t);

/// The same grids, one time after the other: a view of a composite field as one grid a time step,
/// as consumers want it that know nothing of fields. From one time to the next it puts back what
/// the objects had lowered and lowers what they come to, and leaves the rest alone.
class DenseSteps {
 public:
  /// @throws std::invalid_argument without a static grid, or as ComposeDense.
  DenseSteps(std::shared_ptr<const SdfGrid> static_W, std::vector<MovingField> objects);

  /// ComposeDense at time t, in the order of GridSpec::Index. Valid until the next call.
  /// @throws as ComposeDense; the next call then still answers rightly.
  std::span<const float> At(EpisodeTime t);

  const GridSpec& spec() const { return static_W_->spec(); }

  /// The cells of the static grid that an object's grid covers, and the object's cell in the first.
  struct Overlap {
    std::array<int, 3> first, size;  ///< no size is negative; one may be 0
    std::array<int, 3> object_first;
  };

 private:
  std::shared_ptr<const SdfGrid> static_W_;
  std::vector<MovingField> objects_;
  AlignedVector<float> distance_m_;
  std::vector<Overlap> lowered_;  // by the objects, in distance_m_
};

}  // namespace sidestep::sdf
