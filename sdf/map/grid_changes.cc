#include "sidestep/sdf/map/grid_changes.h"

#include <algorithm>
#include <cstring>

namespace sidestep::sdf {

std::span<const std::size_t> GridChanges::Update(const OccupancyGrid& grid,
                                                 const MayDiffer& may_differ) {
  constexpr std::size_t kBlock = 4096;
  const std::vector<std::uint8_t>& cells = grid.cells;
  last_.resize(cells.size(), 0);
  changed_.clear();
  const auto look_at = [&](std::size_t cell) {
    if (cells[cell] == last_[cell]) return;
    changed_.push_back(cell);
    last_[cell] = cells[cell];
  };
  if (may_differ) {
    for (const std::size_t cell : *may_differ) look_at(cell);
    std::sort(changed_.begin(), changed_.end());
    return changed_;
  }
  for (std::size_t begin = 0; begin < cells.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, cells.size());
    if (std::memcmp(&last_[begin], &cells[begin], end - begin) == 0) continue;
    for (std::size_t cell = begin; cell < end; ++cell) look_at(cell);
  }
  return changed_;
}

}  // namespace sidestep::sdf
