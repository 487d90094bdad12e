#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/map/fast_distance_transform.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::sdf {

/// The field of what does not move. Transformed only when it is asked for and has changed.
class StaticMap {
 public:
  explicit StaticMap(DistanceConvention convention = DistanceConvention::kSurface)
      : convention_(convention) {}

  /// @param may_differ all cells that may not be as they were the last time; none: any may.
  void Set(const OccupancyGrid& occupancy,
           const std::optional<std::span<const std::size_t>>& may_differ = {});

  /// Of the occupancy last set; there must be one.
  std::shared_ptr<const SdfGrid> Field();

 private:
  DistanceConvention convention_;
  OccupancyGrid occupancy_;
  FastDistanceTransform transform_;
  std::shared_ptr<const SdfGrid> field_;  // null: not transformed since it changed
};

}  // namespace sidestep::sdf
