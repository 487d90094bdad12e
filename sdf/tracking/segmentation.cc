#include "sdf/tracking/segmentation.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace sidestep {
namespace {

std::array<int, 3> CellAt(const GridSpec& spec, std::size_t index) {
  const std::size_t nx = static_cast<std::size_t>(spec.size[0]);
  const std::size_t ny = static_cast<std::size_t>(spec.size[1]);
  return {static_cast<int>(index % nx), static_cast<int>(index / nx % ny),
          static_cast<int>(index / (nx * ny))};
}

// Takes the component around `seed` out of `pending`.
std::vector<std::size_t> Flood(const GridSpec& spec, std::size_t seed,
                               std::vector<std::uint8_t>& pending) {
  std::vector<std::size_t> cells = {seed};
  pending[seed] = 0;
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const auto [i, j, k] = CellAt(spec, cells[next]);
    for (int c = std::max(k - 1, 0); c <= std::min(k + 1, spec.size[2] - 1); ++c) {
      for (int b = std::max(j - 1, 0); b <= std::min(j + 1, spec.size[1] - 1); ++b) {
        for (int a = std::max(i - 1, 0); a <= std::min(i + 1, spec.size[0] - 1); ++a) {
          const std::size_t neighbour = spec.Index(a, b, c);
          if (pending[neighbour] == 0) continue;
          pending[neighbour] = 0;
          cells.push_back(neighbour);
        }
      }
    }
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

Component Describe(const GridSpec& spec, std::vector<std::size_t> cells) {
  Component component;
  component.first = component.last = CellAt(spec, cells.front());
  std::array<std::int64_t, 3> sum = {0, 0, 0};  // of indices: exact in any order
  for (const std::size_t index : cells) {
    const std::array<int, 3> cell = CellAt(spec, index);
    for (std::size_t a = 0; a < 3; ++a) {
      sum[a] += cell[a];
      component.first[a] = std::min(component.first[a], cell[a]);
      component.last[a] = std::max(component.last[a], cell[a]);
    }
  }
  const Eigen::Vector3d mean =
      Eigen::Vector3d(static_cast<double>(sum[0]), static_cast<double>(sum[1]),
                      static_cast<double>(sum[2])) /
      static_cast<double>(cells.size());
  component.centroid_m = spec.first_center_m + spec.cell_m * mean;
  component.cells = std::move(cells);
  return component;
}

}  // namespace

std::vector<Component> FindComponents(const OccupancyGrid& occupancy) {
  std::vector<Component> components;
  std::vector<std::uint8_t> pending = occupancy.cells;
  const auto is_filled = [](std::uint8_t cell) { return cell != 0; };
  for (auto seed = pending.begin();
       (seed = std::find_if(seed, pending.end(), is_filled)) != pending.end();) {
    const std::size_t index = static_cast<std::size_t>(seed - pending.begin());
    components.push_back(Describe(occupancy.spec, Flood(occupancy.spec, index, pending)));
  }
  return components;
}

OccupancyGrid CutOut(const Component& component, const GridSpec& grid) {
  GridSpec spec = grid;
  spec.first_center_m = grid.Center(component.first[0], component.first[1], component.first[2]);
  for (std::size_t a = 0; a < 3; ++a) spec.size[a] = component.last[a] - component.first[a] + 1;
  OccupancyGrid shape(spec);
  for (const std::size_t index : component.cells) {
    const auto [i, j, k] = CellAt(grid, index);
    shape
        .cells[spec.Index(i - component.first[0], j - component.first[1], k - component.first[2])] =
        1;
  }
  return shape;
}

}  // namespace sidestep
