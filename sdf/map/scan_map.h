#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sidestep/core/cell_touch.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/sdf/map/evidence_map.h"
#include "sidestep/sdf/map/grid_changes.h"
#include "sidestep/sdf/map/occupancy_from_scan.h"

namespace sidestep::sdf {

/// Turns the scans of one or more sensors into one occupancy. A scan of solids (ScanKind::kSolid)
/// tells everything that its sensor knows: filled are the cells that hold a point of its latest
/// one. Scans of surfaces are weighed (sdf/map/evidence_map.h). A cell is filled if any sensor of
/// solids or the cameras together say so.
class ScanMap {
 public:
  /// @param views of the cameras, by their sensors' names.
  /// @throws std::invalid_argument for a bad grid or what EvidenceMap throws.
  ScanMap(const GridSpec& grid_W, const EvidenceOptions& evidence,
          const std::map<std::string, CameraView>& views);

  /// What is filled after this scan, the named objects of the scan left out. Valid until the next
  /// call.
  const OccupancyGrid& Update(const Scan& scan);

  /// All cells of what is filled that the latest scan may have changed; none: any.
  MayDiffer may_differ() const;

  /// Not 0 for each cell that a camera's latest scan looked at; empty: sensors of solids look
  /// everywhere.
  std::span<const std::uint8_t> seen() const;

  /// 1 for each cell where what is filled may have come, as EvidenceMap::once_free has it; empty:
  /// anywhere, for what sensors of solids tell.
  std::span<const std::uint8_t> once_free() const;

 private:
  void Fuse();

  GridSpec grid_W_;
  EvidenceOptions evidence_;
  std::map<std::string, CameraView> views_;
  std::map<std::string, ScanRasteriser> solids_;             // by sensor
  std::map<std::string, const OccupancyGrid*> solid_cells_;  // of the latest scan of each
  std::optional<EvidenceMap> surfaces_;                      // once there was one
  OccupancyGrid fused_;                                      // if there are several of these
  std::vector<std::uint8_t> fused_once_free_;
};

/// Fills the cells of the named objects.
void FillObjects(const std::vector<ObjectObservation>& objects, CellRule rule,
                 OccupancyGrid* occupancy);

}  // namespace sidestep::sdf
