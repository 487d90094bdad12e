#include "sidestep/sdf/map/evidence_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sidestep/sdf/map/cells_on_line.h"
#include "sidestep/sdf/tracking/segmentation.h"

namespace sidestep::sdf {
namespace {

struct UnseenWord {
  UnseenSpace unseen;
  const char* word;
};
constexpr UnseenWord kUnseenWords[] = {{UnseenSpace::kFree, "free"},
                                       {UnseenSpace::kFilled, "filled"},
                                       {UnseenSpace::kRemembered, "remembered"}};

// What the rays of a scan say of a cell, together.
constexpr std::uint8_t kPassed = 1, kHit = 2, kDoubted = 4, kRests = 8;

constexpr int kMostSettleScans = 10000;

constexpr int kRestingScans = 15;  // what a ray has seen unchanged for so long rests

constexpr float kRounding = 1e-4F;  // of sums of log-odds

constexpr std::size_t kMostCameras = 8;  // a bit each

constexpr std::size_t kOutside = std::numeric_limits<std::size_t>::max();

std::size_t IndexOf(const GridSpec& grid, const Eigen::Vector3d& p_W) {
  const auto [i, j, k] = grid.CellOf(p_W);
  return grid.Contains(i, j, k) ? grid.Index(i, j, k) : kOutside;
}

}  // namespace

std::string ToString(UnseenSpace unseen) {
  for (const UnseenWord& entry : kUnseenWords) {
    if (entry.unseen == unseen) return entry.word;
  }
  throw std::invalid_argument("not a kind of unseen space");
}

UnseenSpace UnseenSpaceFromString(const std::string& word) {
  for (const UnseenWord& entry : kUnseenWords) {
    if (entry.word == word) return entry.unseen;
  }
  throw std::invalid_argument("unknown unseen space '" + word +
                              "'; there are: free, filled, remembered");
}

EvidenceMap::EvidenceMap(const GridSpec& grid_W, const EvidenceOptions& options,
                         const std::map<std::string, CameraView>& views)
    : options_(options) {
  CheckGridSpec(grid_W);
  if (!(options.hit > 0) || !(options.miss > 0) || !(options.least < 0) || !(options.most > 0) ||
      !(options.decay_per_s >= 0) || !(options.noise_sigmas >= 0) || options.least_cells < 1 ||
      options.settle_scans < 1 || options.settle_scans > kMostSettleScans ||
      options.average_scans < 1) {
    throw std::invalid_argument("EvidenceMap: options out of their bounds");
  }
  filled_ = new_hits_ = OccupancyGrid(grid_W);
  cells_.resize(grid_W.num_cells());
  once_free_.assign(grid_W.num_cells(), 0);
  in_view_.assign(grid_W.num_cells(), 0);
  marks_.assign(grid_W.num_cells(), 0);
  for (const auto& [name, view] : views) {
    Find(name).view = view;
    // Nobody has seen anything yet, and one of them takes that for filled.
    if (view.unseen != UnseenSpace::kFilled) continue;
    std::fill(filled_.cells.begin(), filled_.cells.end(), std::uint8_t{1});
  }
}

EvidenceMap::Camera& EvidenceMap::Find(const std::string& name) {
  const auto [at, is_new] = cameras_.try_emplace(name);
  if (is_new) {
    if (cameras_.size() > kMostCameras) throw std::invalid_argument("EvidenceMap: 8 cameras");
    at->second.number = static_cast<std::uint8_t>(cameras_.size());
    at->second.depths = SteadyDepths(options_.average_scans);
  }
  return at->second;
}

void EvidenceMap::Update(const Scan& scan) {
  if (!scan.rays.empty() && scan.rays.size() != static_cast<std::size_t>(scan.p_CP.cols())) {
    throw std::invalid_argument("EvidenceMap: a scan has a ray for each of its points, or none");
  }
  Camera& camera = Find(scan.sensor);
  Trace(scan, camera);
  BelieveAtOnce();
  const double dt_s = camera.t_scan ? std::max(0.0, (scan.t - *camera.t_scan).seconds()) : 0;
  camera.t_scan = scan.t;
  const double decay = options_.decay_per_s * dt_s;
  const std::uint8_t bit = camera.bit();
  for (std::size_t index = 0; index < cells_.size(); ++index) {
    const std::uint8_t mark = marks_[index];
    std::uint8_t& in_view = in_view_[index];
    in_view = static_cast<std::uint8_t>(mark != 0 ? in_view | bit : in_view & ~bit);
    if ((mark & kHit) != 0) {
      Hit(cells_[index], index, camera);
      if ((mark & kRests) != 0) Settle(cells_[index], index);
    } else if ((mark & kDoubted) != 0) {
      cells_[index].hit_by &= static_cast<std::uint8_t>(~bit);
    } else if (mark != 0) {
      Pass(cells_[index], index, camera);
    } else if (cells_[index].seen_by != 0) {
      Overlook(cells_[index], index, camera, decay);
    }
  }
  std::fill(marks_.begin(), marks_.end(), std::uint8_t{0});
}

void EvidenceMap::Trace(const Scan& scan, Camera& camera) {
  const GridSpec& grid = filled_.spec;
  const Eigen::Vector3d p_WCamera = scan.X_WC.translation();
  const Eigen::Matrix3d R_WC = scan.X_WC.rotation().toRotationMatrix();
  for (Eigen::Index n = 0; n < scan.p_CFree.cols(); ++n) {
    const Eigen::Vector3d p_WEnd = p_WCamera + R_WC * scan.p_CFree.col(n);
    if (!p_WEnd.allFinite()) continue;
    const std::size_t end = IndexOf(grid, p_WEnd);
    VisitCellsOnLine(grid, p_WCamera, p_WEnd, [&](std::size_t cell, double, double) {
      if (cell == end) return false;
      marks_[cell] |= kPassed;
      return true;
    });
  }
  for (Eigen::Index n = 0; n < scan.p_CP.cols(); ++n) {
    Eigen::Vector3d p_CP = scan.p_CP.col(n);
    if (!p_CP.allFinite()) continue;
    SteadyDepths::Mean mean = {p_CP.z(), 1, false};
    if (!scan.rays.empty() && p_CP.z() > 0) {
      const double depth_m = p_CP.z();
      mean = camera.depths.Take(scan.rays[static_cast<std::size_t>(n)], depth_m,
                                camera.view.noise_per_m * depth_m * depth_m);
      if (mean.count > 1) p_CP *= mean.depth_m / depth_m;
    }
    // Noise moves a point along its ray by so much for each metre of depth.
    const double deviation_m =
        camera.view.noise_per_m * std::abs(p_CP.z()) * p_CP.norm() / std::sqrt(mean.count);
    TracePoint(p_WCamera, p_WCamera + R_WC * p_CP, options_.noise_sigmas * deviation_m, mean);
  }
}

void EvidenceMap::TracePoint(const Eigen::Vector3d& p_WCamera, const Eigen::Vector3d& p_WPoint,
                             double doubt_m, const SteadyDepths::Mean& mean) {
  const GridSpec& grid = filled_.spec;
  const Eigen::Vector3d way = p_WPoint - p_WCamera;
  const double far_m = way.norm();
  const std::size_t end = IndexOf(grid, p_WPoint);
  const auto hit = static_cast<std::uint8_t>(mean.count >= kRestingScans ? kHit | kRests : kHit);
  if (doubt_m == 0) {
    VisitCellsOnLine(grid, p_WCamera, p_WPoint, [&](std::size_t cell, double, double) {
      if (cell == end) return false;
      marks_[cell] |= kPassed;
      return true;
    });
    if (end == kOutside) return;
    marks_[end] |= hit;
    if (!Attracts(end)) new_cells_.push_back(end);
    return;
  }
  // Parts of the line to where it may have ended at the farthest.
  const double whole_m = far_m + doubt_m;
  const double at_end = far_m / whole_m, before_doubt = (far_m - doubt_m) / whole_m;
  std::size_t attractor = kOutside;
  double nearest = std::numeric_limits<double>::infinity();
  VisitCellsOnLine(grid, p_WCamera, p_WCamera + way * (whole_m / far_m),
                   [&](std::size_t cell, double enter, double leave) {
                     if (leave <= before_doubt) {
                       if (cell != end) marks_[cell] |= kPassed;
                       return true;
                     }
                     if (!mean.has_jumped && enter < at_end) marks_[cell] |= kDoubted;
                     const double off = std::max({0.0, enter - at_end, at_end - leave});
                     if (off > nearest) return false;  // it only gets farther
                     if (Attracts(cell)) {
                       attractor = cell;
                       nearest = off;
                     }
                     return true;
                   });
  if (end != kOutside && filled_.cells[end] != 0) {
    marks_[end] |= hit;
    if (!Attracts(end)) new_cells_.push_back(end);
  } else if (attractor != kOutside) {
    marks_[attractor] |= hit;
  } else if (end != kOutside) {
    marks_[end] |= hit;
    new_cells_.push_back(end);
  }
}

bool EvidenceMap::Attracts(std::size_t cell) const {
  return filled_.cells[cell] != 0 && (once_free_[cell] == 0 || IsSettled(cells_[cell]));
}

void EvidenceMap::BelieveAtOnce() {
  const auto believe = [&](std::size_t index) {
    float& log_odds = cells_[index].log_odds;
    log_odds = std::max(log_odds, 0.0F);
  };
  if (options_.least_cells == 1) {
    for (const std::size_t index : new_cells_) believe(index);
  } else if (static_cast<int>(new_cells_.size()) >= options_.least_cells) {
    for (const std::size_t index : new_cells_) new_hits_.cells[index] = 1;
    for (const Component& component : FindComponents(new_hits_)) {
      if (static_cast<int>(component.cells.size()) < options_.least_cells) continue;
      for (const std::size_t index : component.cells) believe(index);
    }
    for (const std::size_t index : new_cells_) new_hits_.cells[index] = 0;
  }
  new_cells_.clear();
}

void EvidenceMap::Hit(Cell& cell, std::size_t index, const Camera& camera) {
  const float sum = cell.log_odds + static_cast<float>(options_.hit);
  cell.log_odds = std::min(sum, static_cast<float>(options_.most));
  cell.seen_by = camera.number;
  cell.hit_by |= camera.bit();
  const bool is_filled = cell.log_odds > kRounding;
  filled_.cells[index] = is_filled ? 1 : 0;
  if (is_filled && !IsSettled(cell)) ++cell.hits;
}

void EvidenceMap::Settle(Cell& cell, std::size_t index) {
  if (filled_.cells[index] == 0) return;
  cell.hits = static_cast<std::uint16_t>(options_.settle_scans);
  once_free_[index] = 0;
}

void EvidenceMap::Pass(Cell& cell, std::size_t index, const Camera& camera) {
  cell.hit_by &= static_cast<std::uint8_t>(~camera.bit());
  if (cell.hit_by != 0) return;
  const auto least = static_cast<float>(options_.least);
  cell.log_odds = std::max(cell.log_odds - static_cast<float>(options_.miss), least);
  cell.seen_by = camera.number;
  if (cell.log_odds > kRounding) return;
  filled_.cells[index] = 0;
  cell.hits = 0;
  if (cell.log_odds <= least + kRounding) once_free_[index] = 1;
}

void EvidenceMap::Overlook(Cell& cell, std::size_t index, const Camera& camera, double decay) {
  cell.hit_by &= static_cast<std::uint8_t>(~camera.bit());
  if (cell.seen_by != camera.number) return;
  if (camera.view.unseen != UnseenSpace::kRemembered) {
    filled_.cells[index] = camera.view.unseen == UnseenSpace::kFilled ? 1 : 0;
    cell = Cell();
    return;
  }
  // What may have been there all the time stays.
  if (once_free_[index] == 0 || IsSettled(cell) || cell.log_odds <= kRounding) return;
  cell.log_odds = std::max(cell.log_odds - static_cast<float>(decay), 0.0F);
  if (cell.log_odds > kRounding) return;
  filled_.cells[index] = 0;
  cell.hits = 0;
}

}  // namespace sidestep::sdf
