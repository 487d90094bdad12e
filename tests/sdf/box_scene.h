#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/time.h"

namespace sidestep::sdf {

/// An axis-aligned box whose centre moves; absent where `is_there` says so.
struct SceneBox {
  Eigen::Vector3d size_m;
  std::function<Eigen::Vector3d(EpisodeTime)> p_WO;
  std::function<bool(EpisodeTime)> is_there = [](EpisodeTime) { return true; };
};

inline SceneBox StillBox(const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_WO) {
  return {size_m, [=](EpisodeTime) { return p_WO; }};
}

inline SceneBox MovingBox(const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_WStart,
                          const Eigen::Vector3d& v_WO) {
  return {size_m, [=](EpisodeTime t) -> Eigen::Vector3d { return p_WStart + t.seconds() * v_WO; }};
}

/// Fills the cells whose centre lies in the box; lower faces belong to it, upper ones do not.
inline void FillBox(const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_WO,
                    OccupancyGrid& grid) {
  std::array<int, 3> begin, end;
  for (std::size_t a = 0; a < 3; ++a) {
    const Eigen::Index axis = static_cast<Eigen::Index>(a);
    const auto first_at_or_above = [&](double x) {
      const double u = std::ceil((x - grid.spec.first_center_m(axis)) / grid.spec.cell_m - 1e-9);
      return static_cast<int>(std::clamp(u, 0.0, static_cast<double>(grid.spec.size[a])));
    };
    begin[a] = first_at_or_above(p_WO(axis) - size_m(axis) / 2);
    end[a] = first_at_or_above(p_WO(axis) + size_m(axis) / 2);
  }
  for (int k = begin[2]; k < end[2]; ++k)
    for (int j = begin[1]; j < end[1]; ++j)
      for (int i = begin[0]; i < end[0]; ++i) grid.cells[grid.spec.Index(i, j, k)] = 1;
}

inline OccupancyGrid Rasterise(const std::vector<SceneBox>& boxes, const GridSpec& spec,
                               EpisodeTime t) {
  OccupancyGrid grid(spec);
  for (const SceneBox& box : boxes) {
    if (box.is_there(t)) FillBox(box.size_m, box.p_WO(t), grid);
  }
  return grid;
}

/// What a perfect sensor reports: the centres of the filled cells.
inline Scan MakeScan(const OccupancyGrid& grid, EpisodeTime t) {
  Scan scan;
  scan.t = t;
  scan.p_CP.resize(3, static_cast<Eigen::Index>(grid.CountFilled()));
  Eigen::Index n = 0;
  for (int k = 0; k < grid.spec.size[2]; ++k)
    for (int j = 0; j < grid.spec.size[1]; ++j)
      for (int i = 0; i < grid.spec.size[0]; ++i)
        if (grid.At(i, j, k)) scan.p_CP.col(n++) = grid.spec.Center(i, j, k);
  return scan;
}

/// The walkway of Finean et al. (ICAPS 2021): a robot of 0.48 x 0.55 x 1.2 m drives in -y between
/// two tables 0.56 m apart, one free cell on either side.
inline GridSpec WalkwayGrid() { return {{-1, -1, -1}, 0.04, {96, 96, 96}}; }
inline std::vector<SceneBox> WalkwayTables() {
  return {StillBox({0.8, 1.2, 0.4}, {-0.31, 0, 0.2}), StillBox({0.8, 1.2, 0.4}, {1.05, 0, 0.2})};
}
inline SceneBox WalkwayRobot(double speed_m_s) {
  return MovingBox({0.48, 0.55, 1.2}, {0.4, 2.0, 0.6}, {0, -speed_m_s, 0});
}

}  // namespace sidestep::sdf
