#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sidestep/core/grid.h"

namespace sidestep::sdf {

/// All cells of a grid that may not be as they were the last time, in any order and more than once;
/// none: any may.
using MayDiffer = std::optional<std::span<const std::size_t>>;

/// Finds what has changed in a grid of cells from one time to the next, so that whoever follows it
/// need not look at all of it: most of a room stays as it is.
class GridChanges {
 public:
  /// The cells that are not as they were at the last call, ascending; at the first, those that are
  /// not free. Valid until the next call. The number of cells may not change.
  std::span<const std::size_t> Update(const OccupancyGrid& grid, const MayDiffer& may_differ = {});

 private:
  std::vector<std::uint8_t> last_;
  std::vector<std::size_t> changed_;
};

}  // namespace sidestep::sdf
