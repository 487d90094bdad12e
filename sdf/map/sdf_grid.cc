#include "sidestep/sdf/map/sdf_grid.h"

#include <stdexcept>
#include <utility>

namespace sidestep::sdf {

SdfGrid::SdfGrid(const GridSpec& spec, AlignedVector<float> distance_m)
    : spec_(spec), cells_per_m_(1 / spec.cell_m), distance_m_(std::move(distance_m)) {
  CheckGridSpec(spec_);
  if (distance_m_.size() != spec_.num_cells()) {
    throw std::invalid_argument("SdfGrid: needs one value a cell");
  }
  last_center_m_ = spec_.Center(spec_.size[0] - 1, spec_.size[1] - 1, spec_.size[2] - 1);
}

}  // namespace sidestep::sdf
