#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/sdf/map/steady_depths.h"

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

/// What is known of a camera whose scans are of surfaces.
struct CameraView {
  UnseenSpace unseen = UnseenSpace::kRemembered;
  double noise_per_m = 0;  ///< its depth z has the standard deviation noise_per_m z^2
};

/// What it takes for a cell to be filled, or free. By default each scan is taken at its word.
struct EvidenceOptions {
  /// Log-odds: what a scan that hits a cell adds, what one that passes through it takes away, and
  /// the bounds. A cell is filled while its sum is > 0, and known to be free at `least`.
  double hit = 2, miss = 2, least = -1, most = 1;
  /// So many scans that hit a cell while it is filled settle it, until it is free: what is there
  /// rests. So does at once what the end of a ray that is averaged over 15 scans hits.
  int settle_scans = 1;
  /// What a filled cell that has not settled loses while the camera that saw it last does not see
  /// it.
  double decay_per_s = 0;
  /// A point that is within so many standard deviations, along its ray, of a cell that was filled
  /// before anything moved there says nothing new: it is a hit of that cell. And no ray says that
  /// cells are free so near to its end; nor so near before the end of another of its scan, if that
  /// one sees what it has seen for longest.
  double noise_sigmas = 0;
  /// What a ray measures is averaged over so many scans for as long as it stays the same, where the
  /// scans say which ray is which; 1: it is not. Noise counts the less for it.
  int average_scans = 1;
  /// So many cells that hang together and are hit by one scan are believed at once, whatever was
  /// known to be free there; fewer have to be hit again and again.
  int least_cells = 1;
};

/// A map of what is filled, by the scans of surfaces of one or more cameras that stand still.
///
/// A ray leads from the camera to each point of a scan: the cells on its way are passed, the one it
/// ends in is hit. A cell that one ray of a scan hits is not passed by others of that scan, and not
/// by those of another camera whose latest scan has hit it: what one sees, another that sees past
/// it does not erase. What a camera does not see is treated as its view says, if no other camera
/// has seen it since.
class EvidenceMap {
 public:
  /// @param views by the names of the sensors; others are as CameraView has it. There may be 8.
  /// @throws std::invalid_argument for a bad grid, options out of their bounds, or more sensors.
  EvidenceMap(const GridSpec& grid_W, const EvidenceOptions& options,
              const std::map<std::string, CameraView>& views);

  /// Takes in a scan of surfaces. Of each sensor they come in the order of capture.
  /// @throws std::invalid_argument if rays are named for some of its points only.
  void Update(const Scan& scan);

  /// In the order of GridSpec::Index.
  const OccupancyGrid& filled() const { return filled_; }

  /// Not 0 for each cell that the latest scan of any camera has looked at, in the same order.
  const std::vector<std::uint8_t>& seen() const { return in_view_; }

  /// 1 for each cell that has been known to be free since something rested there, in the same
  /// order: what is filled there has come, and what is filled elsewhere may have been there all the
  /// time. Something rests where a ray has seen it unchanged for half a second at 30 Hz.
  const std::vector<std::uint8_t>& once_free() const { return once_free_; }

 private:
  struct Cell {
    float log_odds = 0;
    std::uint16_t hits = 0;    // since it is filled, not above settle_scans
    std::uint8_t seen_by = 0;  // the camera that saw it last, from 1; 0: none
    std::uint8_t hit_by = 0;   // the cameras whose latest scan has hit it, a bit each
  };
  struct Camera {
    CameraView view;
    std::uint8_t number = 0;            // from 1
    std::optional<EpisodeTime> t_scan;  // of its latest scan
    SteadyDepths depths{1};
    std::uint8_t bit() const { return static_cast<std::uint8_t>(1U << (number - 1U)); }
  };

  Camera& Find(const std::string& name);
  void Trace(const Scan& scan, Camera& camera);
  bool IsSettled(const Cell& cell) const { return cell.hits >= options_.settle_scans; }
  // @param mean of the ray: where it sees what it has seen for longest, other rays do not free
  // cells where it may have ended either. What has come is no reason to: where it was before would
  // stay filled the longer.
  void TracePoint(const Eigen::Vector3d& p_WCamera, const Eigen::Vector3d& p_WPoint, double doubt_m,
                  const SteadyDepths::Mean& mean);
  // Whether what is filled in a cell explains points that noise has put nearby.
  bool Attracts(std::size_t cell) const;
  void BelieveAtOnce();
  void Hit(Cell& cell, std::size_t index, const Camera& camera);
  void Settle(Cell& cell, std::size_t index);
  void Pass(Cell& cell, std::size_t index, const Camera& camera);
  void Overlook(Cell& cell, std::size_t index, const Camera& camera, double decay);

  EvidenceOptions options_;
  std::map<std::string, Camera> cameras_;
  std::vector<Cell> cells_;
  OccupancyGrid filled_;
  std::vector<std::uint8_t> once_free_;
  std::vector<std::uint8_t> in_view_;  // a bit for each camera whose latest scan looked there
  // Of the scan that is being taken in:
  std::vector<std::uint8_t> marks_;  // by cell
  OccupancyGrid new_hits_;           // where points end that nothing explains
  std::vector<std::size_t> new_cells_;
};

}  // namespace sidestep::sdf
