#include "sdf/dense_composite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace sidestep {

SdfGrid ComposeDense(const SdfGrid& static_W, const std::vector<MovingField>& objects,
                     EpisodeTime t) {
  const GridSpec& spec = static_W.spec();
  std::vector<float> distance_m = static_W.distance_m();
  for (const MovingField& object : objects) {
    const SdfGrid& field = *object.field_O;
    const Pose X_WO = object.X_WO(t);
    if (field.spec().cell_m != spec.cell_m || X_WO.rotation().vec().norm() > 1e-12) {
      throw std::invalid_argument("ComposeDense: objects must share the cell edge and the axes");
    }
    const Eigen::Vector3d p_WFirst = X_WO.translation() + field.spec().first_center_m;
    std::array<int, 3> begin;      // the grid's cell where the object's first one comes to lie
    std::array<int, 3> low, high;  // the object's cells that lie in the grid: low <= i < high
    for (std::size_t a = 0; a < 3; ++a) {
      const Eigen::Index axis = static_cast<Eigen::Index>(a);
      begin[a] =
          static_cast<int>(std::lround((p_WFirst(axis) - spec.first_center_m(axis)) / spec.cell_m));
      low[a] = std::max(0, -begin[a]);
      high[a] = std::min(field.spec().size[a], spec.size[a] - begin[a]);
    }
    for (int k = low[2]; k < high[2]; ++k) {
      for (int j = low[1]; j < high[1]; ++j) {
        for (int i = low[0]; i < high[0]; ++i) {
          float& distance = distance_m[spec.Index(begin[0] + i, begin[1] + j, begin[2] + k)];
          distance = std::min(distance, field.At(i, j, k));
        }
      }
    }
  }
  return SdfGrid(spec, std::move(distance_m));
}

}  // namespace sidestep
