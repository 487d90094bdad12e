#include "sidestep/sdf/tracking/object_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/stopwatch.h"

namespace sidestep::sdf {
namespace {

// How far a thing's border may move between two scans, when it comes off another.
constexpr int kCellsAScan = 2;

// By what share of its cells a thing may seem to grow or shrink when it only turns: cells along its
// surface.
constexpr double kTurnedCells = 0.2;
// And how far its middle may then be from where it was expected, in cells.
constexpr double kTurnedShift = 1.6;

std::array<int, 3> Extent(const Component& component) {
  std::array<int, 3> extent;
  for (std::size_t a = 0; a < 3; ++a) extent[a] = component.last[a] - component.first[a] + 1;
  return extent;
}

// The corners of the box around a component, faces included [m].
Eigen::Vector3d LowCorner(const Component& component, const GridSpec& grid) {
  const auto [i, j, k] = component.first;
  return grid.Center(i, j, k).array() - grid.cell_m / 2;
}
Eigen::Vector3d HighCorner(const Component& component, const GridSpec& grid) {
  const auto [i, j, k] = component.last;
  return grid.Center(i, j, k).array() + grid.cell_m / 2;
}

Eigen::Vector3d PredictPosition(const TrackedObject& object, EpisodeTime t) {
  return object.latest().p_WO +
         MeanVelocity(object.history, kVelocityBaseline) * (t - object.latest().t).seconds();
}

}  // namespace

ObjectTracker::ObjectTracker(const GridSpec& grid, const ObjectTrackerOptions& options)
    : grid_(grid), options_(options), background_(grid) {
  if (!(options_.max_distance_m > 0)) {
    throw std::invalid_argument("ObjectTracker: max_distance_m must be > 0");
  }
}

TrackerTimes ObjectTracker::Update(const OccupancyGrid& occupancy, EpisodeTime t,
                                   std::span<const std::uint8_t> once_free) {
  if (occupancy.spec != grid_) throw std::invalid_argument("ObjectTracker: another grid");
  if (t_last_ && t <= *t_last_) throw std::invalid_argument("ObjectTracker: time must go on");
  t_last_ = t;
  once_free_ = once_free;
  TrackerTimes times;
  Stopwatch stopwatch;

  ReopenVanished(occupancy, t);
  const std::vector<Component> components = FindComponents(occupancy, background_.is_background());
  times.segment_s = stopwatch.Lap();

  for (auto& [id, track] : tracks_) {
    if (track.state == State::kResting) {
      AddSighting(track, See(t, track.object.latest().p_WO));
    } else {
      ++track.missed_scans;  // unless it is found below
    }
  }
  const std::vector<CellBox> views = LatestViews();
  std::vector<Track*> owners = Associate(components, t);
  static_occupancy_ = occupancy;
  std::vector<int> wholes(components.size());  // what each is a part of, if it has just come off
  for (std::size_t c = 0; c < components.size(); ++c) {
    if (owners[c] != nullptr) {
      Follow(*owners[c], components[c], t);
    } else {
      owners[c] = Begin(components[c], t);
      wholes[c] = FindWhole(views, components[c]);
      Note(wholes[c] > 0 ? track_event::kSplit : track_event::kAppeared, *owners[c], t, wholes[c]);
    }
    Track& track = *owners[c];
    track.first = components[c].first;
    track.last = components[c].last;
    Classify(track, components[c], t);
    if (track.state == State::kMoving) {
      const bool is_cut_off = IsCutOff(components[c]);
      if (is_cut_off != track.partly_seen) {
        Note(is_cut_off ? track_event::kPartlySeen : track_event::kWhollySeen, track, t);
      }
      track.partly_seen = is_cut_off;
      for (const std::size_t cell : components[c].cells) static_occupancy_.cells[cell] = 0;
    }
  }
  NoteMerges(components, owners, wholes, t);
  std::erase_if(tracks_, [&](const auto& entry) {
    const Track& track = entry.second;
    const bool is_moving = track.state == State::kMoving;
    const bool is_lost = track.missed_scans > (is_moving ? options_.max_missed_scans : 0);
    if (is_lost && is_moving) Note(track_event::kLost, track, t);
    return is_lost;
  });
  times.track_s = stopwatch.Lap();
  return times;
}

std::vector<std::shared_ptr<const TrackedObject>> ObjectTracker::MovingObjects() const {
  std::vector<std::shared_ptr<const TrackedObject>> objects;
  for (const auto& [id, track] : tracks_) {
    if (track.state == State::kMoving) {
      objects.push_back(std::make_shared<const TrackedObject>(track.object));
    }
  }
  return objects;
}

void ObjectTracker::Note(const char* what, const Track& track, EpisodeTime t, int other_id) {
  events_.push_back({t, what, track.object.id, other_id, track.object.latest().p_WO});
}

std::vector<ObjectTracker::CellBox> ObjectTracker::LatestViews() const {
  std::vector<CellBox> views;
  for (const auto& [id, track] : tracks_) {
    if (track.state != State::kResting) views.push_back({id, track.first, track.last});
  }
  return views;
}

int ObjectTracker::FindWhole(const std::vector<CellBox>& views, const Component& part) {
  for (const CellBox& view : views) {
    bool is_inside = true;
    for (std::size_t a = 0; a < 3; ++a) {
      is_inside &= part.first[a] >= view.first[a] - kCellsAScan &&
                   part.last[a] <= view.last[a] + kCellsAScan;
    }
    if (is_inside) return view.id;
  }
  return 0;
}

void ObjectTracker::NoteMerges(const std::vector<Component>& components,
                               const std::vector<Track*>& owners, const std::vector<int>& wholes,
                               EpisodeTime t) {
  for (const auto& [id, track] : tracks_) {
    if (track.missed_scans != 1) continue;
    const Eigen::Vector3d p_WExpected = PredictPosition(track.object, t);
    int merged_with = 0;
    for (std::size_t c = 0; c < components.size(); ++c) {
      const bool is_inside =
          (p_WExpected.array() >= LowCorner(components[c], grid_).array()).all() &&
          (p_WExpected.array() <= HighCorner(components[c], grid_).array()).all();
      if (is_inside && wholes[c] != id) merged_with = owners[c]->object.id;
    }
    if (merged_with > 0) {
      Note(track_event::kMerged, track, t, merged_with);
    } else if (track.state == State::kMoving) {
      Note(track_event::kMissed, track, t);
    }
  }
}

void ObjectTracker::ReopenVanished(const OccupancyGrid& occupancy, EpisodeTime t) {
  for (const int id : background_.ReleaseVanished(occupancy)) {
    Track& track = tracks_.at(id);
    track.state = State::kNew;
    track.p_WStart = track.object.latest().p_WO;
    track.t_start = t;
    track.settle = options_.rest;
  }
}

std::vector<ObjectTracker::Track*> ObjectTracker::Associate(
    const std::vector<Component>& components, EpisodeTime t) {
  std::vector<std::tuple<double, int, std::size_t>> pairs;  // distance, id, component
  for (const auto& [id, track] : tracks_) {
    if (track.state == State::kResting) continue;
    const double unseen_s = (t - track.object.latest().t).seconds();
    const double gate_m = options_.max_speed_m_s * unseen_s + 2 * grid_.cell_m;
    const Eigen::Vector3d p_WExpected = PredictPosition(track.object, t);
    for (std::size_t c = 0; c < components.size(); ++c) {
      const double distance_m = (Locate(track, components[c]) - p_WExpected).norm();
      if (distance_m <= gate_m) pairs.emplace_back(distance_m, id, c);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  std::vector<Track*> owners(components.size(), nullptr);
  for (const auto& [distance_m, id, c] : pairs) {
    Track& track = tracks_.at(id);
    if (track.missed_scans == 0 || owners[c] != nullptr) continue;
    if (track.missed_scans > 1) Note(track_event::kFound, track, t);
    track.missed_scans = 0;
    owners[c] = &track;
  }
  return owners;
}

ObjectTracker::Track* ObjectTracker::Begin(const Component& component, EpisodeTime t) {
  const int id = next_id_++;
  Track& track = tracks_[id];
  track.object.id = id;
  track.object.first_seen = t;
  track.object.history = {See(t, component.centroid_m)};
  track.p_WStart = component.centroid_m;
  track.t_start = t;
  // What has come is not at rest because it was just seen.
  track.settle = !once_free_.empty() && MayHaveCome(component) ? options_.rest : options_.settle;
  TakeShape(track, component);
  return &track;
}

void ObjectTracker::Follow(Track& track, const Component& component, EpisodeTime t) const {
  const std::array<int, 3> extent = Extent(component);
  bool is_longer = false;
  bool is_other = false;
  for (std::size_t a = 0; a < 3; ++a) {
    is_longer |= extent[a] > track.extent[a];
    // A rigid thing covers one cell more or less, depending on where it stands.
    is_other |= std::abs(extent[a] - track.extent[a]) > 1;
  }
  const bool is_whole = !IsCutOff(component);
  const bool deformed = is_other && is_whole && !track.cut_off;
  const bool completed = is_whole && track.cut_off;
  const bool grew = is_longer && component.cells.size() > track.num_cells;
  // What turns has another outline of about as many cells around a middle that goes on as before.
  // What merges or parts has more or fewer; of a surface that shows another side, the middle jumps.
  const Eigen::Vector3d p_WSeen = Locate(track, component);
  const Eigen::Vector3d p_WExpected = PredictPosition(track.object, t);
  const auto before = static_cast<double>(track.num_cells);
  const auto now = static_cast<double>(component.cells.size());
  const bool has_turned = std::abs(now - before) <= kTurnedCells * before &&
                          (p_WSeen - p_WExpected).norm() <= kTurnedShift * grid_.cell_m;
  AddSighting(track, See(t, deformed && !has_turned ? p_WExpected : p_WSeen));
  if (deformed || completed || grew) TakeShape(track, component);
}

void ObjectTracker::Classify(Track& track, const Component& component, EpisodeTime t) {
  const double moved_m = options_.moved_cells * grid_.cell_m;
  const Eigen::Vector3d& p_WO = track.object.latest().p_WO;
  bool rests = false;
  if (track.state == State::kNew) {
    if ((p_WO - track.p_WStart).norm() >= moved_m && MayHaveCome(component)) {
      track.state = State::kMoving;
      TakeShape(track, component);  // now with its field
      Note(track_event::kMoved, track, t);
    } else {
      rests = t - track.t_start >= track.settle;
    }
  } else {
    const EpisodeTime since = t - options_.rest;
    const auto stayed = [&](const Sighting& sighting) {
      return sighting.t < since || (p_WO - sighting.p_WO).norm() < moved_m;
    };
    const std::vector<Sighting>& history = track.object.history;
    rests = history.front().t <= since && std::all_of(history.begin(), history.end(), stayed);
  }
  if (rests) {
    track.state = State::kResting;
    Note(track_event::kRested, track, t);
    track.object.field_O.reset();
    background_.Absorb(track.object.id, component);
  }
}

bool ObjectTracker::MayHaveCome(const Component& component) const {
  if (once_free_.empty()) return true;
  const auto count = std::count_if(component.cells.begin(), component.cells.end(),
                                   [&](std::size_t cell) { return once_free_[cell] != 0; });
  return count >= options_.least_cells;
}

Sighting ObjectTracker::See(EpisodeTime t, const Eigen::Vector3d& p_WO) const {
  // Uniform over a cell: off by up to half of one to either side.
  return {t, p_WO, grid_.cell_m / std::sqrt(12.0)};
}

Eigen::Vector3d ObjectTracker::Locate(const Track& track, const Component& component) const {
  const Eigen::Vector3d low = LowCorner(component, grid_);
  const Eigen::Vector3d high = HighCorner(component, grid_);
  const TrackedObject& object = track.object;
  Eigen::Vector3d p_WO = component.centroid_m;
  for (std::size_t a = 0; a < 3; ++a) {
    const bool sees_low = component.first[a] > 0;
    const bool sees_high = component.last[a] < grid_.size[a] - 1;
    const Eigen::Index axis = static_cast<Eigen::Index>(a);
    if (sees_low && !sees_high) {
      p_WO(axis) = low(axis) - (object.box_center_O - object.box_half_extents_m)(axis);
    } else if (sees_high && !sees_low) {
      p_WO(axis) = high(axis) - (object.box_center_O + object.box_half_extents_m)(axis);
    }
  }
  return p_WO;
}

bool ObjectTracker::IsCutOff(const Component& component) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (component.first[a] == 0 || component.last[a] == grid_.size[a] - 1) return true;
  }
  return false;
}

void ObjectTracker::AddSighting(Track& track, const Sighting& sighting) const {
  std::vector<Sighting>& history = track.object.history;
  std::erase_if(history, [&](const Sighting& old) { return sighting.t - old.t > options_.memory; });
  history.push_back(sighting);
}

void ObjectTracker::TakeShape(Track& track, const Component& component) const {
  TrackedObject& object = track.object;
  const Eigen::Vector3d shift_W = component.centroid_m - object.latest().p_WO;
  for (Sighting& sighting : object.history) sighting.p_WO += shift_W;
  track.p_WStart += shift_W;

  const Eigen::Vector3d low = LowCorner(component, grid_);
  const Eigen::Vector3d high = HighCorner(component, grid_);
  object.box_center_O = (low + high) / 2 - component.centroid_m;
  object.box_half_extents_m = (high - low) / 2;
  track.extent = Extent(component);
  track.num_cells = component.cells.size();
  track.cut_off = IsCutOff(component);
  if (track.state != State::kMoving) return;  // what does not move needs no field of its own
  OccupancyGrid shape_O = CutOut(component, grid_);
  shape_O.spec.first_center_m -= component.centroid_m;
  object.field_O = std::make_shared<const SdfGrid>(
      MakeObjectField(shape_O, options_.max_distance_m, options_.convention));
}

}  // namespace sidestep::sdf
