#include "sidestep/sdf/map/static_map.h"

namespace sidestep::sdf {

void StaticMap::Set(const OccupancyGrid& occupancy) {
  if (occupancy.spec == occupancy_.spec && occupancy.cells == occupancy_.cells) return;
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
