#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/tag_track.h"
#include "sidestep/sdf/tracking/tracked_object.h"

namespace sidestep::sdf {

/// An object with a name, and how it is turned: TrackedObject keeps the axes of W.
struct NamedObject {
  std::shared_ptr<const TrackedObject> object;
  Eigen::Quaterniond R_WO = Eigen::Quaterniond::Identity();  ///< as last seen
  bool has_left = false;                                     ///< seen last outside of what is kept
};

struct NamedObjectsOptions {
  double cell_m = 0, max_distance_m = 0;     ///< of the objects' fields, and where they are clamped
  HorizonOffset coast{1};                    ///< what has not been seen for longer is forgotten ...
  std::optional<GridSpec> keep_within = {};  ///< ... unless it was seen last in these cells
  /// What sightings must pass; nothing: whoever sends them has judged them.
  std::optional<TagTrackOptions> gates = {};
};

/// The gates for tags that may be wrong, which nobody has looked at yet: things that brake with
/// 2 m/s^2 pass, and what is turned by the other of the two poses that explain a tag does not.
TagTrackOptions GatesOfTags(double max_speed_m_s, HorizonOffset coast);

/// Follows objects that a sensor names, such as those with tags: no segmentation and no
/// association, because each observation says which object it is of and what shape that has.
///
/// Behind gates (core/tag_track.h) an object begins when three sightings agree. One that does not
/// fit is left out; four in a row that do not are the truth if three of them agree, and the history
/// is then those. Of several of one name in a scan, the one that fits best is looked at.
class NamedObjects {
 public:
  explicit NamedObjects(const NamedObjectsOptions& options) : options_(options) {}

  /// Takes in what was seen at time t. An object that has not been seen for `coast` is forgotten,
  /// but for those that are kept.
  void Update(const std::vector<ObjectObservation>& objects, EpisodeTime t);

  /// Everything that is followed, in the order of first sight. The shape's own frame is O. Ids are
  /// -1, -2, ..., apart from those of things that are tracked from occupancy.
  std::vector<NamedObject> Objects() const;

  /// What has been noticed since the last call, in order: words of object_tracker.h.
  std::vector<TrackEvent> TakeEvents() { return std::exchange(events_, {}); }

 private:
  static constexpr HorizonOffset kMemory{2};  ///< how far back a history reaches

  struct Track {
    TrackedObject object;
    Eigen::Quaterniond R_WO;
  };
  // What is known of a name, whether or not there is something to follow.
  struct Name {
    int id;
    TagTrack gate;
    std::vector<Sighting> offered;  // those that the gate may begin with
    int num_too_fast = 0;           // in a row
  };

  void Take(Name& name, const ObjectObservation& seen);
  void Note(const char* what, const Name& name, const ObjectObservation& seen);
  Track& TrackOf(const Name& name, const ObjectObservation& seen);
  void Add(Track& track, const Sighting& sighting) const;
  bool HasLeft(const TrackedObject& object) const;
  bool IsForgotten(const TrackedObject& object, EpisodeTime t) const;

  NamedObjectsOptions options_;
  std::map<std::string, Name> names_;  ///< every one ever seen
  std::map<int, Track> tracks_;
  std::vector<TrackEvent> events_;
};

}  // namespace sidestep::sdf
