#include "sidestep/sdf/tracking/background.h"

#include <iterator>
#include <utility>

namespace sidestep::sdf {
Background::Background(const GridSpec& grid) : foreground_(0) {
  CheckGridSpec(grid);
  foreground_ = SearchBlocks(grid.num_cells());
  is_background_.assign(grid.num_cells(), 0);
}

void Background::Absorb(int id, const Component& component) {
  owned_[id] = {component.cells, component.cells.size()};
  for (const std::size_t cell : component.cells) is_background_[cell] = 1;
}

void Background::TakeIn(const OccupancyGrid& occupancy, const MayDiffer& may_differ) {
  if (!may_differ) {
    foreground_.MarkAll();
    may_have_vanished_ = true;
    return;
  }
  for (const std::size_t cell : *may_differ) {
    foreground_.Mark(cell);
    may_have_vanished_ |= is_background_[cell] != 0 && occupancy.cells[cell] == 0;
  }
}

std::vector<int> Background::ReleaseVanished(const OccupancyGrid& occupancy, double lost_share) {
  std::vector<int> released;
  if (!std::exchange(may_have_vanished_, false)) return released;
  for (auto it = owned_.begin(); it != owned_.end();) {
    Owned& owned = it->second;
    std::erase_if(owned.cells, [&](std::size_t cell) {
      if (occupancy.cells[cell] != 0) return false;
      is_background_[cell] = 0;
      return true;
    });
    const double held = static_cast<double>(owned.cells.size());
    if (held >= (1 - lost_share) * static_cast<double>(owned.num_absorbed)) {
      ++it;
      continue;
    }
    for (const std::size_t cell : owned.cells) {
      is_background_[cell] = 0;
      foreground_.Mark(cell);
    }
    released.push_back(it->first);
    it = owned_.erase(it);
  }
  return released;
}

}  // namespace sidestep::sdf
