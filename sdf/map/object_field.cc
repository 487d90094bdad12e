#include "sidestep/sdf/map/object_field.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sidestep/sdf/map/fast_distance_transform.h"

namespace sidestep::sdf {
namespace {

void CheckMargin(double margin_m) {
  if (!(margin_m > 0)) throw std::invalid_argument("object field: the margin must be > 0");
}

}  // namespace

int PaddingCells(double margin_m, double cell_m) {
  return static_cast<int>(std::ceil(margin_m / cell_m)) + 1;
}

SdfGrid MakeObjectField(const OccupancyGrid& shape_O, double margin_m,
                        DistanceConvention convention) {
  CheckGridSpec(shape_O.spec);
  CheckMargin(margin_m);
  const int padding = PaddingCells(margin_m, shape_O.spec.cell_m);
  GridSpec spec = shape_O.spec;
  spec.first_center_m.array() -= padding * spec.cell_m;
  for (int& size : spec.size) size += 2 * padding;

  OccupancyGrid padded(spec);
  const auto [nx, ny, nz] = shape_O.spec.size;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        padded.cells[spec.Index(i + padding, j + padding, k + padding)] = shape_O.At(i, j, k);
      }
    }
  }
  return FastDistanceTransform().Compute(padded, {.convention = convention});
}

double ShapeFieldCells(const Shape& shape, double cell_m, double margin_m) {
  double cells = 1;
  for (const double half_extent_m : HalfExtents(shape)) {
    cells *= 2 * (std::ceil((half_extent_m + margin_m) / cell_m) + 1) + 1;
  }
  return cells;
}

SdfGrid MakeShapeField(const Shape& shape, double cell_m, double margin_m) {
  CheckMargin(margin_m);
  if (!(cell_m > 0)) throw std::invalid_argument("object field: the cell must be > 0");
  if (!(ShapeFieldCells(shape, cell_m, margin_m) <= kMostShapeFieldCells)) {
    throw std::invalid_argument("object field: the shape is too large for its cells");
  }
  const Eigen::Vector3d half_extents_m = HalfExtents(shape);
  GridSpec spec;
  spec.cell_m = cell_m;
  for (int a = 0; a < 3; ++a) {
    const int half = PaddingCells(half_extents_m(a) + margin_m, cell_m);
    spec.size[static_cast<std::size_t>(a)] = 2 * half + 1;
    spec.first_center_m(a) = -half * cell_m;
  }
  AlignedVector<float> distance_m;
  distance_m.reserve(spec.num_cells());
  for (int k = 0; k < spec.size[2]; ++k) {
    for (int j = 0; j < spec.size[1]; ++j) {
      for (int i = 0; i < spec.size[0]; ++i) {
        distance_m.push_back(static_cast<float>(SignedDistance(shape, spec.Center(i, j, k))));
      }
    }
  }
  return SdfGrid(spec, std::move(distance_m));
}

}  // namespace sidestep::sdf
