#pragma once

#include <Eigen/Core>
#include <optional>

#include "sidestep/core/grid.h"

namespace sidestep::bench {

/// The scene of the field benchmarks: a table on four legs and a cabinet with shelves in the
/// workspace of Finean et al. (ICAPS 2021), a cube of 3.84 m in n^3 cells, and a pillar of
/// 0.30 x 0.30 x 1.80 m, their moving obstacle. With it, 1.4 % of the cells are filled.
inline constexpr double kRoom_m = 3.84;
inline const Eigen::Vector3d kPillarSize_m(0.30, 0.30, 1.80);
/// Where the pillar's lower corner stands unless it is said.
inline const Eigen::Vector3d kPillar(1.76, 0.40, 0);

GridSpec RoomGrid(int n);

/// @param p_WPillar lower corner of the pillar [m]; without it the room has none.
OccupancyGrid FurnishedRoom(int n, const std::optional<Eigen::Vector3d>& p_WPillar);

}  // namespace sidestep::bench
