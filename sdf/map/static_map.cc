#include "sidestep/sdf/map/static_map.h"

namespace sidestep::sdf {

void StaticMap::Set(const OccupancyGrid& occupancy, const MayDiffer& may_differ) {
  const bool is_of_same_grid = occupancy.spec == occupancy_.spec;
  if (may_differ && is_of_same_grid) {
    for (const std::size_t cell : *may_differ) {
      if (occupancy_.cells[cell] == occupancy.cells[cell]) continue;
      occupancy_.cells[cell] = occupancy.cells[cell];
      field_.reset();
    }
    return;
  }
  if (is_of_same_grid && occupancy.cells == occupancy_.cells) return;
  occupancy_ = occupancy;
  field_.reset();
}

std::shared_ptr<const SdfGrid> StaticMap::Field() {
  if (!field_) {
    field_ = std::make_shared<const SdfGrid>(
        transform_.Compute(occupancy_, {.convention = convention_}));
  }
  return field_;
}

}  // namespace sidestep::sdf
