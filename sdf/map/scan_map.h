#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sidestep/core/cell_touch.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/sdf/map/occupancy_from_scan.h"

namespace sidestep::sdf {

/// What to take for true of space that a camera does not see: behind things, outside its view.
enum class UnseenSpace {
  kFree,        ///< nothing is there
  kFilled,      ///< something solid is there
  kRemembered,  ///< what was last seen there; nothing, where nobody ever looked
};
/// "free", "filled", "remembered".
std::string ToString(UnseenSpace unseen);
/// @throws std::invalid_argument for another word.
UnseenSpace UnseenSpaceFromString(const std::string& word);

/// Turns scans into occupancy. A scan of solids (ScanKind::kSolid) tells everything: filled are the
/// cells that hold a point. In a scan of surfaces, a ray leads from the sensor to each point: the
/// cells on its way are seen to be free, the cell it ends in is filled, and one that any point lies
/// in is filled whatever passes through. The rest is unseen.
class ScanMap {
 public:
  /// @throws std::invalid_argument for a bad grid.
  ScanMap(const GridSpec& grid_W, UnseenSpace unseen);

  /// What is filled after this scan, the named objects of the scan left out. Valid until the next
  /// call.
  const OccupancyGrid& Update(const Scan& scan);

  /// One byte a cell: 0 where the latest scan did not look. Empty: it looked everywhere.
  std::span<const std::uint8_t> seen() const { return seen_; }

 private:
  void FillUnseen();  // the map as it is where nobody looked

  UnseenSpace unseen_;
  ScanRasteriser rasteriser_;
  OccupancyGrid map_;  // after the last scan of surfaces
  std::vector<std::uint8_t> seen_;
};

/// The cells that a straight line passes through on its way from `start` to `end`, the end's own
/// left out; only those in the grid. Each is visited once, in order.
/// Source: J. Amanatides, A. Woo, "A fast voxel traversal algorithm for ray tracing", Eurographics
/// 1987.
void VisitCellsOnTheWay(const GridSpec& grid_W, const Eigen::Vector3d& p_WStart,
                        const Eigen::Vector3d& p_WEnd, std::vector<std::size_t>* cells);

/// Fills the cells of the named objects.
void FillObjects(const std::vector<ObjectObservation>& objects, CellRule rule,
                 OccupancyGrid* occupancy);

}  // namespace sidestep::sdf
