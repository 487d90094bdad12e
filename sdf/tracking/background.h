#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/sdf/map/grid_changes.h"
#include "sidestep/sdf/tracking/segmentation.h"

namespace sidestep::sdf {

/// The cells of things that rest. What is filled and not background is the foreground, where things
/// are told apart: so a thing that moves past a resting one and touches it stays a component of its
/// own.
class Background {
 public:
  /// @throws std::invalid_argument for a bad grid.
  explicit Background(const GridSpec& grid);

  /// Makes a component background, owned by `id` until that is released.
  void Absorb(int id, const Component& component);

  /// What is filled has changed.
  void TakeIn(const OccupancyGrid& occupancy, const MayDiffer& may_differ);

  /// Lets go of the cells that are free now. An owner that has lost more than this share of its
  /// cells since it was absorbed does not rest any more: all its cells are released, so that it is
  /// in the foreground as a whole. Returns those owners, ascending.
  std::vector<int> ReleaseVanished(const OccupancyGrid& occupancy, double lost_share);

  /// What is filled and not background.
  std::vector<Component> FindForeground(const OccupancyGrid& occupancy) {
    return FindComponents(occupancy, is_background_, &foreground_);
  }

 private:
  struct Owned {
    std::vector<std::size_t> cells;  // those still held
    std::size_t num_absorbed = 0;    // how many there were
  };

  std::vector<std::uint8_t> is_background_;  // of each cell of the grid
  std::map<int, Owned> owned_;               // by owner
  SearchBlocks foreground_;
  bool may_have_vanished_ = false;  // some of it, since it was looked at last
};

}  // namespace sidestep::sdf
