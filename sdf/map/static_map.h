#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/map/fast_distance_transform.h"
#include "sidestep/sdf/map/grid_changes.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// The field of what does not move. Transformed only when it is asked for and has changed.
class StaticMap {
 public:
  explicit StaticMap(DistanceConvention convention = DistanceConvention::kSurface)
      : convention_(convention) {}

  void Set(const OccupancyGrid& occupancy, const MayDiffer& may_differ = {});

  /// Of the occupancy last set; there must be one.
  std::shared_ptr<const SdfGrid> Field();

 private:
  DistanceConvention convention_;
  OccupancyGrid occupancy_;
  FastDistanceTransform transform_;
  std::shared_ptr<const SdfGrid> field_;  // null: not transformed since it changed
};

}  // namespace sidestep::sdf
