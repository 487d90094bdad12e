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
#include "sidestep/sdf/map/grid_changes.h"
#include "sidestep/sdf/prediction/motion_filter.h"
#include "sidestep/sdf/tracking/background.h"
#include "sidestep/sdf/tracking/segmentation.h"
#include "sidestep/sdf/tracking/tracked_object.h"

namespace sidestep::sdf {

struct ObjectTrackerOptions {
  double max_distance_m = 0;  ///< > 0; objects' fields are padded for this
  /// The gate: since last seen, a thing is at most this far from where it should be, and two cells
  /// for what cells round. A thing that is new should be where it was, so it is followed from a
  /// speed of 0 up to max_speed_m_s + 2 cells * the rate of scans (6.4 m/s with 4 cm and 30 Hz); a
  /// faster one is new in each scan, believed to rest, and told of. Docs: docs/prediction.md.
  double max_speed_m_s = 4;
  double moved_cells = 0.75;  ///< a thing that is this far from where it began is moving
  /// If it has so many cells that were once known to be free; what else grows is only seen better.
  int least_cells = 1;
  HorizonOffset settle{0.06};  ///< a thing seen for this long that has not moved is static
  HorizonOffset peek{0.2};     ///< the same for a thing of which a part came out from hiding
  HorizonOffset rest{0.4};     ///< the same for a thing that is known to have moved or come
  HorizonOffset memory{2};     ///< how far back a history reaches
  DistanceConvention convention = DistanceConvention::kSurface;  ///< of objects' fields
  /// A moving thing that is not where one looked for more scans in a row is given up ...
  int max_missed_scans = 3;
  HorizonOffset coast{1};  ///< ... and one that is where one cannot look, after this
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
inline constexpr const char* kHidden = "hidden";
inline constexpr const char* kTooFast = "too_fast";
inline constexpr const char* kRefused = "refused";
}  // namespace track_event

/// CPU seconds that one Update took, for the report only.
struct TrackerTimes {
  double segment_s = 0, track_s = 0;
};

/// What is known of a grid's cells, one byte each.
struct Sight {
  std::span<const std::uint8_t> seen = {};       ///< 0 where one does not look; empty: everywhere
  std::span<const std::uint8_t> once_free = {};  ///< 1 where it was ever known to be free; or empty
};

/// Follows the things in a stream of occupancy grids, and tells what moves from what does not.
///
/// Each thing is new, moving or resting. A new one is static until it has moved by most of a cell,
/// to where a camera had seen nothing before, or has left most of the cells where it was; if it has
/// not within `settle`, it rests: its cells become background. A resting thing that
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
/// What is not found goes on as expected. It is given up after a few scans where it should have
/// been seen; hidden, when most of its cells would be where nobody looked, it coasts for longer, by
/// the constant-velocity filter over its past, and is found again by what that is sure of. A side
/// that borders on unseen space is taken for the thing's own only if it is where it was; otherwise
/// a part is hidden: positions are measured from the other side and the larger shape is kept, for
/// as long as things coast. Moving things that are seen in one piece are told apart in it: each of
/// its cells belongs to the one whose box should be nearest.
///
/// Deterministic: ties go to the older thing and the lower cell.
class ObjectTracker {
 public:
  /// @throws std::invalid_argument for a bad grid or max_distance_m not > 0.
  ObjectTracker(const GridSpec& grid, const ObjectTrackerOptions& options);

  /// Takes in what is filled at time t.
  /// @throws std::invalid_argument for another grid, or unless t is later than the last.
  TrackerTimes Update(const OccupancyGrid& occupancy, EpisodeTime t, const Sight& sight = {},
                      const MayDiffer& may_differ = {});

  /// The things that move, by id, also those that the latest scan did not show.
  std::vector<std::shared_ptr<const TrackedObject>> MovingObjects() const;

  /// What has been noticed since the last call, in order.
  std::vector<TrackEvent> TakeEvents() { return std::exchange(events_, {}); }

  /// What was filled in the latest scan and does not belong to a moving thing.
  const OccupancyGrid& static_occupancy() const { return static_occupancy_; }
  /// All cells of it that may not be as they were before the latest scan; none: any may.
  MayDiffer static_may_differ() const {
    if (!knows_differences_) return std::nullopt;
    return static_may_differ_;
  }

 private:
  enum class State { kNew, kMoving, kResting };

  // A thing, and what its shape was like when it was taken.
  struct Track {
    TrackedObject object;
    State state = State::kNew;
    Eigen::Vector3d p_WStart;                 // where it was when it was new
    EpisodeTime t_start;                      // since when it is new
    HorizonOffset settle;                     // how long it may stay so
    std::vector<std::size_t> cells_at_start;  // of its first view since then, ascending
    std::array<int, 3> extent = {0, 0, 0};    // of its shape, in cells
    std::size_t num_cells = 0;
    bool cut_off = false;                         // by the grid's border: there may be more of it
    std::vector<std::array<int, 3>> shape_cells;  // of what moves, from its first corner
    Eigen::Vector3d p_OFirst;                     // where the centre of that corner's cell is
    int missed_scans = 0;                         // in a row
    int contradicted_scans = 0;                   // of these, those that looked where it should be
    // While it is hidden, what its past says at its latest sighting.
    std::optional<MotionEstimate> coasting;
    std::array<int, 3> first = {0, 0, 0}, last = {0, 0, 0};  // the cells around its latest view
    bool partly_seen = false;                                // then
    bool is_merged = false;                                  // in one piece with an older thing
    EpisodeTime t_whole;                                     // when no part of it was hidden
    EpisodeTime t_came_out;                                  // when it was hidden last
  };

  // What is seen of something.
  struct View {
    Component cells;
    // On which sides it borders on space that nobody looked at: there may be more of it.
    std::array<bool, 3> is_open_low = {}, is_open_high = {};
    Track* owner = nullptr;
    bool is_part = false;  // of what is seen in one piece
    int whole_id = 0;      // of the thing that it has just come off; 0: none
  };

  struct Expectation {
    Eigen::Vector3d p_WO;
    double gate_m = 0;  // how far from there it may be
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
  void NoteMerges(const std::vector<View>& views, EpisodeTime t);
  void NoteTooFast(const View& view, EpisodeTime t);
  void CopyStatic(const OccupancyGrid& occupancy, const MayDiffer& may_differ);
  void LeaveOut(const Component& component);
  void ReopenVanished(const OccupancyGrid& occupancy, EpisodeTime t);
  std::vector<View> Look(std::vector<Component> components) const;
  // Whether it is but what is remembered of a moving thing, which may be anywhere by now.
  bool IsMemory(const Component& component, const std::vector<CellBox>& latest) const;
  // The moving things that should be in this piece, if it is large enough for all of them.
  std::vector<Track*> ThingsIn(const Component& piece, EpisodeTime t);
  // Whether it is but a small part of a moving thing, of which surfaces are seen.
  bool IsCrumb(const Component& component, const std::vector<CellBox>& latest) const;
  // Takes pieces in which several moving things should be apart, each part with its owner.
  std::vector<View> TellApart(std::vector<View> views, EpisodeTime t);
  // Gives views their owners: the tracks that they belong to.
  void Associate(std::vector<View>* views, EpisodeTime t);
  Track* Begin(const View& view, EpisodeTime t);
  void Follow(Track& track, const View& view, EpisodeTime t) const;
  void Classify(Track& track, const View& view, EpisodeTime t);
  // Whether what is filled there can have come from elsewhere.
  bool MayHaveCome(const Component& component) const;
  bool HasLeft(const Track& track, const Component& component) const;
  void Miss(Track& track, EpisodeTime t);
  void GiveUp(EpisodeTime t);

  Expectation Expect(const Track& track, EpisodeTime t) const;
  // Calls visit(cell) for the cells in the grid that its shape fills if its frame is at p_WO.
  template <class Visit>
  void VisitShape(const Track& track, const Eigen::Vector3d& p_WO, const Visit& visit) const;
  // Whether most of the cells that it should fill are where nobody looked.
  bool IsHidden(const Track& track, EpisodeTime t) const;
  Sighting See(EpisodeTime t, const Eigen::Vector3d& p_WO) const;
  // Whether there may be more of it on one side.
  static bool IsPartly(const View& view);
  // Whether a side along axis `a` is not the thing's own, and so hides how long it is there.
  static bool HidesItsLength(const Track& track, const View& view, std::size_t a);
  // Where O is, if `view` is one of the track's shape.
  Eigen::Vector3d Locate(const Track& track, const View& view) const;
  bool IsCutOff(const Component& component) const;
  void AddSighting(Track& track, const Sighting& sighting) const;
  // Makes the component the track's shape; O moves to its centroid, and the whole past with it.
  void TakeShape(Track& track, const Component& component) const;

  GridSpec grid_;
  ObjectTrackerOptions options_;
  Background background_;
  OccupancyGrid static_occupancy_;
  std::vector<std::size_t> left_out_;  // of it, in the latest scan: what belongs to moving things
  bool knows_differences_ = false;
  std::vector<std::size_t> static_may_differ_;
  std::vector<TrackEvent> events_;
  std::map<int, Track> tracks_;  // by id, hence from the oldest to the newest
  // Of the scan that is being taken in, as Sight has it.
  std::span<const std::uint8_t> seen_, once_free_;
  int next_id_ = 1;
  std::optional<EpisodeTime> t_first_, t_last_;
};

}  // namespace sidestep::sdf
