#include "sidestep/sdf/map/scan_map.h"

#include <algorithm>

#include "sidestep/sdf/map/cells_near.h"

namespace sidestep::sdf {

ScanMap::ScanMap(const GridSpec& grid_W, const EvidenceOptions& evidence,
                 const std::map<std::string, CameraView>& views)
    : grid_W_(grid_W), evidence_(evidence), views_(views) {
  CheckGridSpec(grid_W);
}

const OccupancyGrid& ScanMap::Update(const Scan& scan) {
  if (scan.kind == ScanKind::kSolid) {
    ScanRasteriser& rasteriser = solids_.try_emplace(scan.sensor, grid_W_).first->second;
    const OccupancyGrid& filled = rasteriser.Fill(scan);
    solid_cells_[scan.sensor] = &filled;
    if (solids_.size() == 1 && !surfaces_) return filled;
  } else {
    if (!surfaces_) surfaces_.emplace(grid_W_, evidence_, views_);
    surfaces_->Update(scan);
    if (solids_.empty()) return surfaces_->filled();
  }
  Fuse();
  return fused_;
}

MayDiffer ScanMap::may_differ() const {
  if (solids_.size() != 1 || surfaces_) return std::nullopt;
  return solids_.begin()->second.may_differ();
}

void ScanMap::Fuse() {
  fused_ = surfaces_ ? surfaces_->filled() : OccupancyGrid(grid_W_);
  if (surfaces_) fused_once_free_ = surfaces_->once_free();
  for (const auto& [sensor, solid] : solid_cells_) {
    for (std::size_t cell = 0; cell < fused_.cells.size(); ++cell) {
      if (solid->cells[cell] == 0) continue;
      fused_.cells[cell] = 1;
      if (surfaces_) fused_once_free_[cell] = 1;
    }
  }
}

std::span<const std::uint8_t> ScanMap::seen() const {
  if (!surfaces_) return {};
  return surfaces_->seen();
}

std::span<const std::uint8_t> ScanMap::once_free() const {
  if (!surfaces_) return {};
  return solids_.empty() ? surfaces_->once_free() : fused_once_free_;
}

void FillObjects(const std::vector<ObjectObservation>& objects, CellRule rule,
                 OccupancyGrid* occupancy) {
  for (const ObjectObservation& object : objects) {
    VisitFilledCells(occupancy->spec, object.shape, object.X_WO, rule, /*skin_m=*/0,
                     [&](std::size_t cell) { occupancy->cells[cell] = 1; });
  }
}

}  // namespace sidestep::sdf
