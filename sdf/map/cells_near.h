#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/shape.h"

namespace sidestep::sdf {

/// Calls visit(index, distance_m) for each cell whose centre may be within `reach_m` >= 0 of a
/// thing where it is seen, and some more, with the centre's signed distance to it.
template <class Visitor>
void VisitCellsNear(const GridSpec& grid_W, const ObjectObservation& thing, double reach_m,
                    const Visitor& visit) {
  const Pose X_OW = thing.X_WO.Inverse();
  const Eigen::Vector3d p_WO = thing.X_WO.translation();
  const Eigen::Vector3d half_W =
      thing.X_WO.rotation().toRotationMatrix().cwiseAbs() * HalfExtents(thing.shape) +
      Eigen::Vector3d::Constant(reach_m + grid_W.cell_m);
  std::array<int, 3> first = grid_W.CellOf(p_WO - half_W);
  std::array<int, 3> last = grid_W.CellOf(p_WO + half_W);
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = std::max(first[a], 0);
    last[a] = std::min(last[a], grid_W.size[a] - 1);
  }
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int i = first[0]; i <= last[0]; ++i) {
        visit(grid_W.Index(i, j, k), SignedDistance(thing.shape, X_OW * grid_W.Center(i, j, k)));
      }
    }
  }
}

}  // namespace sidestep::sdf
