#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/time.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/tracking/background.h"
#include "sidestep/sdf/tracking/segmentation.h"
#include "sidestep/sdf/tracking/tracked_object.h"

namespace sidestep::sdf {

struct ObjectTrackerOptions {
  double max_distance_m = 0;  ///< > 0; objects' fields are padded for this
  /// The gate: since last seen, a thing is at most this far from where it should be, and two cells
  /// for what cells round. A thing that is new should be where it was, so it is followed from a
  /// speed of 0 up to max_speed_m_s + 2 cells * the rate of scans (6.4 m/s with 4 cm and 30 Hz); a
  /// faster one is new in each scan and believed to rest. Docs: docs/prediction.md.
  double max_speed_m_s = 4;
  double moved_cells = 0.75;  ///< a thing that is this far from where it began is moving
  /// If it has so many cells that were once known to be free; what else grows is only seen better.
  int least_cells = 1;
  HorizonOffset settle{0.06};  ///< a thing seen for this long that has not moved is static
  HorizonOffset rest{0.4};     ///< the same for a thing that is known to have moved or come
  HorizonOffset memory{2};     ///< how far back a history reaches
  DistanceConvention convention = DistanceConvention::kSurface;  ///< of objects' fields
  int max_missed_scans = 3;  ///< a moving thing unseen for more scans in a row is given up
};

/// What a TrackEvent may say; docs/trace.md explains the words.
namespace track_event {
inline constexpr const char* kAppeared = "appeared";
inline constexpr const char* kMoved = "moved";
inline constexpr const char* kRested = "rested";
inline constexpr const char* kPartlySeen = "partly_seen";
inline constexpr const char* kWhollySeen = "wholly_seen";
inline constexpr const char* kMerged = "merged";
inline constexpr const char* kSplit = "split";
inline constexpr const char* kMissed = "missed";
inline constexpr const char* kFound = "found";
inline constexpr const char* kLost = "lost";
}  // namespace track_event

/// CPU seconds that one Update took, for the report only.
struct TrackerTimes {
  double segment_s = 0, track_s = 0;
};

/// Follows the things in a stream of occupancy grids, and tells what moves from what does not.
///
/// Each thing is new, moving or resting. A new one is static until it has moved by most of a cell;
/// if it has not within `settle`, it rests: its cells become background. A resting thing that
/// loses cells is new again, with its past; a moving one that stays for `rest` rests. In the
/// foreground, 26-connected components are associated with the known things, nearest pair first and
/// one to one, by the distance to where a thing should be by now, within a gate.
///
/// A position is the centroid of the component. Where the grid's border cuts a thing off, it is
/// measured from the face that is seen instead, so that a thing that enters or leaves has its true
/// speed and keeps the most of its shape that was ever seen. When the outline changes otherwise,
/// the cells are its new shape. If they are about as many, around a middle that is near to where it
/// was expected, it has turned, and is where it is seen; else (two things merge or part, a surface
/// shows another side) it is taken to have moved on as before, and later positions are those of the
/// new shape.
///
/// Deterministic: ties go to the older thing and the lower cell.
class ObjectTracker {
 public:
  /// @throws std::invalid_argument for a bad grid or max_distance_m not > 0.
  ObjectTracker(const GridSpec& grid, const ObjectTrackerOptions& options);

  /// Takes in what is filled at time t.
  /// @param once_free 1 for each cell that was ever known to be free; empty: all were.
  /// @throws std::invalid_argument for another grid, or unless t is later than the last.
  TrackerTimes Update(const OccupancyGrid& occupancy, EpisodeTime t,
                      std::span<const std::uint8_t> once_free = {});

  /// The things that move, by id, also those that the latest scan did not show.
  std::vector<std::shared_ptr<const TrackedObject>> MovingObjects() const;

  /// What has been noticed since the last call, in order.
  std::vector<TrackEvent> TakeEvents() { return std::exchange(events_, {}); }

  /// What was filled in the latest scan and does not belong to a moving thing.
  const OccupancyGrid& static_occupancy() const { return static_occupancy_; }

 private:
  enum class State { kNew, kMoving, kResting };

  // A thing, and what its shape was like when it was taken.
  struct Track {
    TrackedObject object;
    State state = State::kNew;
    Eigen::Vector3d p_WStart;               // where it was when it was new
    EpisodeTime t_start;                    // since when it is new
    HorizonOffset settle;                   // how long it may stay so
    std::array<int, 3> extent = {0, 0, 0};  // of its shape, in cells
    std::size_t num_cells = 0;
    bool cut_off = false;  // by the grid's border: there may be more of it
    int missed_scans = 0;
    std::array<int, 3> first = {0, 0, 0}, last = {0, 0, 0};  // the cells around its latest view
    bool partly_seen = false;                                // then
  };

  // The cells around a thing when it was last seen.
  struct CellBox {
    int id;
    std::array<int, 3> first, last;
  };

  std::vector<CellBox> LatestViews() const;  // of what does not rest
  // The thing whose latest view held all of `part`; 0: none.
  static int FindWhole(const std::vector<CellBox>& views, const Component& part);
  void Note(const char* what, const Track& track, EpisodeTime t, int other_id = 0);
  // Tells of things not found in this scan: whether they are one component with another thing now.
  // `wholes`: the id of the thing that a component has come off, or 0.
  void NoteMerges(const std::vector<Component>& components, const std::vector<Track*>& owners,
                  const std::vector<int>& wholes, EpisodeTime t);
  void ReopenVanished(const OccupancyGrid& occupancy, EpisodeTime t);
  // For each component the track that it belongs to, or nothing.
  std::vector<Track*> Associate(const std::vector<Component>& components, EpisodeTime t);
  Track* Begin(const Component& component, EpisodeTime t);
  void Follow(Track& track, const Component& component, EpisodeTime t) const;
  void Classify(Track& track, const Component& component, EpisodeTime t);
  // Whether what is filled there can have come from elsewhere.
  bool MayHaveCome(const Component& component) const;

  Sighting See(EpisodeTime t, const Eigen::Vector3d& p_WO) const;
  // Where O is, if `component` is a view of the track's shape.
  Eigen::Vector3d Locate(const Track& track, const Component& component) const;
  bool IsCutOff(const Component& component) const;
  void AddSighting(Track& track, const Sighting& sighting) const;
  // Makes the component the track's shape; O moves to its centroid, and the whole past with it.
  void TakeShape(Track& track, const Component& component) const;

  GridSpec grid_;
  ObjectTrackerOptions options_;
  Background background_;
  OccupancyGrid static_occupancy_;
  std::vector<TrackEvent> events_;
  std::map<int, Track> tracks_;  // by id, hence from the oldest to the newest
  int next_id_ = 1;
  std::optional<EpisodeTime> t_last_;
  std::span<const std::uint8_t> once_free_;  // while a scan is taken in
};

}  // namespace sidestep::sdf
