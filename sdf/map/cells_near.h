#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "sidestep/core/cell_touch.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/pose.h"
#include "sidestep/core/shape.h"

namespace sidestep::sdf {

/// Calls visit(index) for each cell of the grid that a shape fills by a rule. Under kCentre, also
/// for those whose centres are less than `skin_m` >= 0 outside it.
template <class Visitor>
void VisitFilledCells(const GridSpec& grid_W, const Shape& shape, const Pose& X_WO, CellRule rule,
                      double skin_m, const Visitor& visit) {
  const Eigen::Matrix3d R_WO = X_WO.rotation().toRotationMatrix();
  const Eigen::Vector3d& p_WO = X_WO.translation();
  const Eigen::Vector3d half_W =
      R_WO.cwiseAbs() * HalfExtents(shape) + Eigen::Vector3d::Constant(skin_m + grid_W.cell_m);
  std::array<int, 3> first = grid_W.CellOf(p_WO - half_W);
  std::array<int, 3> last = grid_W.CellOf(p_WO + half_W);
  for (std::size_t a = 0; a < 3; ++a) {
    first[a] = std::max(first[a], 0);
    last[a] = std::min(last[a], grid_W.size[a] - 1);
  }
  const auto visit_where = [&](const auto& is_filled) {
    for (int k = first[2]; k <= last[2]; ++k) {
      for (int j = first[1]; j <= last[1]; ++j) {
        for (int i = first[0]; i <= last[0]; ++i) {
          if (is_filled(grid_W.Center(i, j, k))) visit(grid_W.Index(i, j, k));
        }
      }
    }
  };
  if (rule == CellRule::kTouched) {
    visit_where(CubeTouch(shape, R_WO, p_WO, grid_W.cell_m));
  } else {
    visit_where([&, X_OW = X_WO.Inverse()](const Eigen::Vector3d& p_WCenter) {
      return SignedDistance(shape, X_OW * p_WCenter) < skin_m;
    });
  }
}

}  // namespace sidestep::sdf
