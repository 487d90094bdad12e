#include "sidestep/bench/micro/furnished_room.h"

#include <algorithm>
#include <array>

namespace sidestep::bench {
namespace {

void AddBox(const Eigen::Vector3d& lower_m, const Eigen::Vector3d& upper_m, OccupancyGrid& grid) {
  std::array<int, 3> lower = grid.spec.CellOf(lower_m);
  std::array<int, 3> upper = grid.spec.CellOf(upper_m);
  for (std::size_t a = 0; a < 3; ++a) {
    lower[a] = std::max(lower[a], 0);
    upper[a] = std::min(upper[a], grid.spec.size[a]);
  }
  for (int k = lower[2]; k < upper[2]; ++k) {
    for (int j = lower[1]; j < upper[1]; ++j) {
      for (int i = lower[0]; i < upper[0]; ++i) grid.cells[grid.spec.Index(i, j, k)] = 1;
    }
  }
}

}  // namespace

GridSpec RoomGrid(int n) {
  const double cell_m = kRoom_m / n;
  return {Eigen::Vector3d::Constant(cell_m / 2), cell_m, {n, n, n}};
}

OccupancyGrid FurnishedRoom(int n, const std::optional<Eigen::Vector3d>& p_WPillar) {
  OccupancyGrid grid(RoomGrid(n));
  const double thickness_m = 0.08;
  AddBox({2.4, 1.0, 0.72}, {3.2, 2.8, 0.80}, grid);
  for (const double x : {2.4, 3.2 - thickness_m}) {
    for (const double y : {1.0, 2.8 - thickness_m}) {
      AddBox({x, y, 0}, {x + thickness_m, y + thickness_m, 0.72}, grid);
    }
  }
  AddBox({0.32, 1.32, 0}, {0.40, 2.52, 2.0}, grid);  // Its back.
  for (const double y : {1.32, 2.52 - thickness_m}) {
    AddBox({0.32, y, 0}, {0.92, y + thickness_m, 2.0}, grid);
  }
  for (const double z : {0.0, 0.64, 1.28, 2.0 - thickness_m}) {
    AddBox({0.32, 1.32, z}, {0.92, 2.52, z + thickness_m}, grid);
  }
  if (p_WPillar) AddBox(*p_WPillar, *p_WPillar + kPillarSize_m, grid);
  return grid;
}

}  // namespace sidestep::bench
