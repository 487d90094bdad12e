#pragma once

#include <memory>

#include "core/grid.h"
#include "sdf/map/sdf_grid.h"

namespace sidestep {

/// The field of what does not move. Transformed only when it is asked for and has changed.
class StaticMap {
 public:
  void Set(const OccupancyGrid& occupancy);

  /// Of the occupancy last set; there must be one.
  std::shared_ptr<const SdfGrid> Field();

 private:
  OccupancyGrid occupancy_;
  std::shared_ptr<const SdfGrid> field_;  // null: not transformed since it changed
};

}  // namespace sidestep
