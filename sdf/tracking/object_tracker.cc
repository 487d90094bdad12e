#include "sidestep/sdf/tracking/object_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/prediction/kalman_cv.h"
#include "sidestep/sdf/stopwatch.h"

namespace sidestep::sdf {
namespace {

// Of a surface that moves, noise leaves parts behind and puts others before it; what is smaller
// than this part of it, and where it was, is one of these.
constexpr double kCrumb = 0.25;

// By what share of its cells a thing that rests has to shrink to be looked at anew: one layer of a
// thing 20 cells long. What one sees of surfaces becomes clear only by and by.
constexpr double kLostShare = 0.05, kLostShareOfSurface = 0.3;

// How far a thing's border may move between two scans, when it comes off another.
constexpr int kCellsAScan = 2;

// By what share of its cells a thing may seem to grow or shrink when it only turns: cells along its
// surface.
constexpr double kTurnedCells = 0.2;
// And how far its middle may then be from where it was expected, in cells.
constexpr double kTurnedShift = 1.6;

// A piece of which less was seen in a scan is only remembered.
constexpr double kLeastSeen = 0.1;

// A thing that is seen to have left so much of where it was has moved.
constexpr double kLeftShare = 0.5;
// If it has come so far besides, and is so many times the least: noise leaves what it is at.
constexpr double kSurelyMovedCells = 3;
constexpr std::size_t kSurelyAThing = 10;

// Things are in one piece if it fills so much of where each should be, and has so many cells of
// what they have together.
constexpr double kLeastShare = 0.5, kLeastOfAll = 0.7;

std::array<int, 3> Extent(const Component& component) {
  std::array<int, 3> extent;
  for (std::size_t a = 0; a < 3; ++a) extent[a] = component.last[a] - component.first[a] + 1;
  return extent;
}

double SmallerToLarger(std::size_t a, std::size_t b) {
  return static_cast<double>(std::min(a, b)) / static_cast<double>(std::max(a, b));
}

struct PlacedBox {
  Eigen::Vector3d center, half_extents;
};

// Cells by the box that each is nearest to, along the axis where it is farthest outside; the first
// one of equals.
std::vector<std::vector<std::size_t>> ShareOut(const std::vector<std::size_t>& cells,
                                               const GridSpec& grid,
                                               const std::vector<PlacedBox>& boxes) {
  std::vector<std::vector<std::size_t>> shares(boxes.size());
  for (const std::size_t cell : cells) {
    const Eigen::Vector3d p = grid.CenterOf(cell);
    const auto outside_m = [&](const PlacedBox& box) {
      return ((p - box.center).cwiseAbs() - box.half_extents).maxCoeff();
    };
    const auto nearest = std::min_element(
        boxes.begin(), boxes.end(),
        [&](const PlacedBox& a, const PlacedBox& b) { return outside_m(a) < outside_m(b); });
    shares[static_cast<std::size_t>(nearest - boxes.begin())].push_back(cell);
  }
  return shares;
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
                                   const Sight& sight, const MayDiffer& may_differ) {
  if (occupancy.spec != grid_) throw std::invalid_argument("ObjectTracker: another grid");
  for (const auto& bytes : {sight.seen, sight.once_free}) {
    if (bytes.empty() || bytes.size() == occupancy.cells.size()) continue;
    throw std::invalid_argument("ObjectTracker: sight needs one byte a cell");
  }
  if (t_last_ && t <= *t_last_) throw std::invalid_argument("ObjectTracker: time must go on");
  t_last_ = t;
  if (!t_first_) t_first_ = t;
  seen_ = sight.seen;
  once_free_ = sight.once_free;
  TrackerTimes times;
  Stopwatch stopwatch;

  background_.TakeIn(occupancy, may_differ);
  ReopenVanished(occupancy, t);
  std::vector<Component> components = background_.FindForeground(occupancy);
  times.segment_s = stopwatch.Lap();

  for (auto& [id, track] : tracks_) {
    if (track.state == State::kResting) {
      AddSighting(track, See(t, track.object.latest().p_WO));
    } else {
      ++track.missed_scans;  // unless it is found below
    }
  }
  const std::vector<CellBox> latest = LatestViews();
  CopyStatic(occupancy, may_differ);
  std::erase_if(components, [&](const Component& component) {
    if (!IsMemory(component, latest) && !IsCrumb(component, latest)) return false;
    LeaveOut(component);
    return true;
  });
  std::vector<View> views = TellApart(Look(std::move(components)), t);
  Associate(&views, t);
  for (View& view : views) {
    if (view.owner != nullptr) {
      Follow(*view.owner, view, t);
    } else {
      NoteTooFast(view, t);
      view.owner = Begin(view, t);
      view.whole_id = FindWhole(latest, view.cells);
      Note(view.whole_id > 0 ? track_event::kSplit : track_event::kAppeared, *view.owner, t,
           view.whole_id);
    }
    Track& track = *view.owner;
    track.first = view.cells.first;
    track.last = view.cells.last;
    Classify(track, view, t);
    if (track.state == State::kMoving) {
      const bool is_cut_off = IsCutOff(view.cells);
      if (is_cut_off != track.partly_seen) {
        Note(is_cut_off ? track_event::kPartlySeen : track_event::kWhollySeen, track, t);
      }
      track.partly_seen = is_cut_off;
      LeaveOut(view.cells);
    }
  }
  for (auto& [id, track] : tracks_) {
    if (track.missed_scans > 0) Miss(track, t);
  }
  NoteMerges(views, t);
  GiveUp(t);
  seen_ = once_free_ = {};
  times.track_s = stopwatch.Lap();
  return times;
}

void ObjectTracker::CopyStatic(const OccupancyGrid& occupancy, const MayDiffer& may_differ) {
  knows_differences_ = may_differ && static_occupancy_.spec == occupancy.spec;
  static_may_differ_.clear();
  if (knows_differences_) {
    // What was left out may be there again.
    static_may_differ_.assign(may_differ->begin(), may_differ->end());
    static_may_differ_.insert(static_may_differ_.end(), left_out_.begin(), left_out_.end());
    for (const std::size_t cell : static_may_differ_) {
      static_occupancy_.cells[cell] = occupancy.cells[cell];
    }
  } else {
    static_occupancy_ = occupancy;
  }
  left_out_.clear();
}

void ObjectTracker::LeaveOut(const Component& component) {
  for (const std::size_t cell : component.cells) static_occupancy_.cells[cell] = 0;
  left_out_.insert(left_out_.end(), component.cells.begin(), component.cells.end());
  static_may_differ_.insert(static_may_differ_.end(), component.cells.begin(),
                            component.cells.end());
}

void ObjectTracker::Miss(Track& track, EpisodeTime t) {
  if (track.state != State::kMoving || !IsHidden(track, t)) {
    ++track.contradicted_scans;
    return;
  }
  if (track.coasting) return;
  MotionFilter filter(kConstantVelocity, track.object.history.front());
  for (std::size_t n = 1; n < track.object.history.size(); ++n) {
    filter.Update(track.object.history[n]);
  }
  track.coasting = filter.AnchoredEstimate();
  Note(track_event::kHidden, track, t);
}

void ObjectTracker::GiveUp(EpisodeTime t) {
  std::erase_if(tracks_, [&](const auto& entry) {
    const Track& track = entry.second;
    const bool is_moving = track.state == State::kMoving;
    const int most_missed = is_moving ? options_.max_missed_scans : 0;
    const bool has_coasted = track.missed_scans > most_missed &&
                             t - track.object.latest().t > options_.coast && !seen_.empty();
    const bool is_lost = track.contradicted_scans > most_missed || has_coasted;
    if (is_lost && is_moving) Note(track_event::kLost, track, t);
    return is_lost;
  });
}

bool ObjectTracker::IsHidden(const Track& track, EpisodeTime t) const {
  if (seen_.empty()) return false;
  std::size_t num_cells = 0, num_unseen = 0;
  VisitShape(track, Expect(track, t).p_WO, [&](std::size_t cell) {
    ++num_cells;
    num_unseen += seen_[cell] == 0 ? 1 : 0;
  });
  return num_cells > 0 && 2 * num_unseen >= num_cells;
}

template <class Visit>
void ObjectTracker::VisitShape(const Track& track, const Eigen::Vector3d& p_WO,
                               const Visit& visit) const {
  const std::array<int, 3> first = grid_.CellOf(p_WO + track.p_OFirst);
  for (const auto& [di, dj, dk] : track.shape_cells) {
    const int i = first[0] + di, j = first[1] + dj, k = first[2] + dk;
    if (grid_.Contains(i, j, k)) visit(grid_.Index(i, j, k));
  }
}

std::vector<ObjectTracker::View> ObjectTracker::Look(std::vector<Component> components) const {
  std::vector<View> views;
  views.reserve(components.size());
  for (Component& component : components) {
    View& view = views.emplace_back();
    view.cells = std::move(component);
    if (seen_.empty()) continue;
    // Of the cells that lie outermost on each side, how many have an unseen one beyond.
    std::array<std::array<int, 2>, 3> outermost = {}, open = {};
    for (const std::size_t index : view.cells.cells) {
      const std::array<int, 3> cell = grid_.CellAt(index);
      for (std::size_t a = 0; a < 3; ++a) {
        for (const std::size_t side : {0u, 1u}) {
          if (cell[a] != (side == 0 ? view.cells.first : view.cells.last)[a]) continue;
          std::array<int, 3> beyond = cell;
          beyond[a] += side == 0 ? -1 : 1;
          const auto [i, j, k] = beyond;
          ++outermost[a][side];
          open[a][side] += grid_.Contains(i, j, k) && seen_[grid_.Index(i, j, k)] == 0 ? 1 : 0;
        }
      }
    }
    for (std::size_t a = 0; a < 3; ++a) {
      view.is_open_low[a] = 2 * open[a][0] >= outermost[a][0];
      view.is_open_high[a] = 2 * open[a][1] >= outermost[a][1];
    }
  }
  return views;
}

bool ObjectTracker::IsMemory(const Component& component, const std::vector<CellBox>& latest) const {
  if (seen_.empty()) return false;
  const auto num_seen = std::count_if(component.cells.begin(), component.cells.end(),
                                      [&](std::size_t cell) { return seen_[cell] != 0; });
  if (static_cast<double>(num_seen) >= kLeastSeen * static_cast<double>(component.cells.size())) {
    return false;
  }
  const int id = FindWhole(latest, component);
  return id > 0 && tracks_.at(id).state == State::kMoving;
}

bool ObjectTracker::IsCrumb(const Component& component, const std::vector<CellBox>& latest) const {
  if (once_free_.empty()) return false;
  const int id = FindWhole(latest, component);
  if (id == 0 || tracks_.at(id).state != State::kMoving) return false;
  return static_cast<double>(component.cells.size()) <
         kCrumb * static_cast<double>(tracks_.at(id).num_cells);
}

std::vector<ObjectTracker::Track*> ObjectTracker::ThingsIn(const Component& piece, EpisodeTime t) {
  std::vector<Track*> things;
  std::size_t num_of_all = 0;
  const Eigen::Vector3d low = LowCorner(piece, grid_), high = HighCorner(piece, grid_);
  for (auto& [id, track] : tracks_) {
    if (track.state != State::kMoving || track.coasting || track.missed_scans == 0) continue;
    const Eigen::Vector3d p_WO = Expect(track, t).p_WO, p_WBox = p_WO + track.object.box_center_O;
    if ((p_WBox.array() < low.array()).any() || (p_WBox.array() > high.array()).any()) continue;
    std::size_t num_cells = 0, num_filled = 0;
    VisitShape(track, p_WO, [&](std::size_t cell) {
      ++num_cells;
      num_filled += std::binary_search(piece.cells.begin(), piece.cells.end(), cell) ? 1 : 0;
    });
    if (static_cast<double>(num_filled) < kLeastShare * static_cast<double>(num_cells)) continue;
    things.push_back(&track);
    num_of_all += num_cells;
  }
  const bool holds_all =
      static_cast<double>(piece.cells.size()) >= kLeastOfAll * static_cast<double>(num_of_all);
  return holds_all ? things : std::vector<Track*>();
}

std::vector<ObjectTracker::View> ObjectTracker::TellApart(std::vector<View> views, EpisodeTime t) {
  const auto moves = [](const auto& entry) { return entry.second.state == State::kMoving; };
  if (std::count_if(tracks_.begin(), tracks_.end(), moves) < 2) return views;
  std::vector<View> apart;
  for (View& view : views) {
    const std::vector<Track*> things = ThingsIn(view.cells, t);
    if (things.size() < 2) {
      apart.push_back(std::move(view));
      continue;
    }
    std::vector<PlacedBox> boxes;
    for (const Track* const thing : things) {
      boxes.push_back(
          {Expect(*thing, t).p_WO + thing->object.box_center_O, thing->object.box_half_extents_m});
    }
    std::vector<std::vector<std::size_t>> shares = ShareOut(view.cells.cells, grid_, boxes);
    for (std::size_t n = 0; n < things.size(); ++n) {
      if (shares[n].empty()) continue;
      View& part = apart.emplace_back();
      part.cells = MakeComponent(std::move(shares[n]), grid_);
      part.owner = things[n];
      part.owner->missed_scans = 0;
      part.is_part = true;
      if (n > 0 && !std::exchange(part.owner->is_merged, true)) {
        Note(track_event::kMerged, *part.owner, t, things[0]->object.id);
      }
    }
  }
  return apart;
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

void ObjectTracker::NoteMerges(const std::vector<View>& views, EpisodeTime t) {
  for (const auto& [id, track] : tracks_) {
    if (track.missed_scans != 1 || track.coasting) continue;
    const Eigen::Vector3d p_WExpected = Expect(track, t).p_WO;
    int merged_with = 0;
    for (const View& view : views) {
      const bool is_inside = (p_WExpected.array() >= LowCorner(view.cells, grid_).array()).all() &&
                             (p_WExpected.array() <= HighCorner(view.cells, grid_).array()).all();
      if (is_inside && view.whole_id != id) merged_with = view.owner->object.id;
    }
    if (merged_with > 0) {
      Note(track_event::kMerged, track, t, merged_with);
    } else if (track.state == State::kMoving) {
      Note(track_event::kMissed, track, t);
    }
  }
}

// Where something like what was there a scan ago is farther off than a thing may go.
void ObjectTracker::NoteTooFast(const View& view, EpisodeTime t) {
  constexpr double kAlike = 0.8, kGates = 4;
  for (const auto& [id, track] : tracks_) {
    if (track.state == State::kResting || track.missed_scans != 1) continue;
    if (SmallerToLarger(track.num_cells, view.cells.cells.size()) < kAlike) continue;
    const std::array<int, 3> extent = Extent(view.cells);
    const bool is_alike = std::equal(extent.begin(), extent.end(), track.extent.begin(),
                                     [](int a, int b) { return std::abs(a - b) <= 1; });
    if (!is_alike) continue;
    const Expectation expected = Expect(track, t);
    if ((Locate(track, view) - expected.p_WO).norm() > kGates * expected.gate_m) continue;
    Note(track_event::kTooFast, track, t);
    return;
  }
}

void ObjectTracker::ReopenVanished(const OccupancyGrid& occupancy, EpisodeTime t) {
  const double lost_share = once_free_.empty() ? kLostShare : kLostShareOfSurface;
  for (const int id : background_.ReleaseVanished(occupancy, lost_share)) {
    Track& track = tracks_.at(id);
    track.state = State::kNew;
    track.p_WStart = track.object.latest().p_WO;
    track.t_start = t;
    track.settle = options_.rest;
    track.cells_at_start.clear();
  }
}

ObjectTracker::Expectation ObjectTracker::Expect(const Track& track, EpisodeTime t) const {
  const HorizonOffset unseen = t - track.object.latest().t;
  const double gate_m = options_.max_speed_m_s * unseen.seconds() + 2 * grid_.cell_m;
  if (!track.coasting) return {PredictPosition(track.object, t), gate_m};
  constexpr double kSigmas = 3;
  const MotionEstimate now = Propagate(kConstantVelocity, *track.coasting, unseen.seconds());
  const double sigma_m = std::sqrt(now.P.block<3, 3>(kP, kP).diagonal().maxCoeff());
  return {now.x.segment<3>(kP), std::min(gate_m, kSigmas * sigma_m + 2 * grid_.cell_m)};
}

void ObjectTracker::Associate(std::vector<View>* views, EpisodeTime t) {
  std::vector<std::tuple<double, int, std::size_t>> pairs;  // distance, id, view
  for (const auto& [id, track] : tracks_) {
    if (track.state == State::kResting || track.missed_scans == 0) continue;
    const Expectation expected = Expect(track, t);
    for (std::size_t v = 0; v < views->size(); ++v) {
      if ((*views)[v].owner != nullptr) continue;
      const double distance_m = (Locate(track, (*views)[v]) - expected.p_WO).norm();
      if (distance_m <= expected.gate_m) pairs.emplace_back(distance_m, id, v);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  for (const auto& [distance_m, id, v] : pairs) {
    Track& track = tracks_.at(id);
    View& view = (*views)[v];
    if (track.missed_scans == 0 || view.owner != nullptr) continue;
    const bool was_merged = std::exchange(track.is_merged, false);
    if (track.missed_scans > 1 || was_merged) Note(track_event::kFound, track, t);
    track.missed_scans = 0;
    view.owner = &track;
  }
  for (const View& view : *views) {
    if (view.owner == nullptr) continue;
    view.owner->contradicted_scans = 0;
    if (view.owner->coasting) view.owner->t_came_out = view.owner->t_whole = t;
    view.owner->coasting.reset();
  }
}

ObjectTracker::Track* ObjectTracker::Begin(const View& view, EpisodeTime t) {
  const Component& component = view.cells;
  const int id = next_id_++;
  Track& track = tracks_[id];
  track.object.id = id;
  track.object.first_seen = t;
  track.object.history = {See(t, component.centroid_m)};
  track.p_WStart = component.centroid_m;
  track.t_start = track.t_whole = t;
  const bool comes_out = t_first_ != t && IsPartly(view);
  track.settle = comes_out ? options_.peek : options_.settle;
  // What has come is not at rest because it was just seen.
  if (!once_free_.empty() && MayHaveCome(component)) track.settle = options_.rest;
  track.cells_at_start = component.cells;
  TakeShape(track, component);
  return &track;
}

void ObjectTracker::Follow(Track& track, const View& view, EpisodeTime t) const {
  const Component& component = view.cells;
  const std::array<int, 3> extent = Extent(component);
  bool is_longer = false;
  bool is_other = false;
  bool is_hidden = false;
  for (std::size_t a = 0; a < 3; ++a) {
    is_longer |= extent[a] > track.extent[a];
    // A rigid thing covers one cell more or less, depending on where it stands.
    is_other |= std::abs(extent[a] - track.extent[a]) > 1;
    is_hidden |= HidesItsLength(track, view, a);
  }
  if (!is_hidden) track.t_whole = t;
  const bool may_be_hidden = is_hidden && t - track.t_whole <= options_.coast;
  const bool is_whole = !IsCutOff(component);
  const bool deformed = is_other && is_whole && !track.cut_off && !may_be_hidden;
  const bool completed = is_whole && track.cut_off;
  const bool grew = is_longer && component.cells.size() > track.num_cells;
  // What turns has another outline of about as many cells around a middle that goes on as before.
  // What merges or parts has more or fewer; of a surface that shows another side, the middle jumps.
  const Eigen::Vector3d p_WSeen = Locate(track, view);
  const Eigen::Vector3d p_WExpected = PredictPosition(track.object, t);
  const auto before = static_cast<double>(track.num_cells);
  const auto now = static_cast<double>(component.cells.size());
  const bool has_turned = std::abs(now - before) <= kTurnedCells * before &&
                          (p_WSeen - p_WExpected).norm() <= kTurnedShift * grid_.cell_m;
  const bool is_measured = view.is_part ? has_turned : !deformed || has_turned;
  AddSighting(track, See(t, is_measured ? p_WSeen : p_WExpected));
  // What is told apart by where things should be does not tell their shapes.
  if (!view.is_part && (deformed || completed || grew)) TakeShape(track, component);
}

void ObjectTracker::Classify(Track& track, const View& view, EpisodeTime t) {
  const Component& component = view.cells;
  const double moved_m = options_.moved_cells * grid_.cell_m;
  const Eigen::Vector3d& p_WO = track.object.latest().p_WO;
  bool rests = false;
  if (track.state == State::kNew) {
    if (track.cells_at_start.empty()) track.cells_at_start = component.cells;
    const double way_m = (p_WO - track.p_WStart).norm();
    if ((way_m >= moved_m && MayHaveCome(component)) ||
        (way_m >= kSurelyMovedCells * grid_.cell_m && HasLeft(track, component))) {
      track.state = State::kMoving;
      TakeShape(track, component);  // now with its field
      Note(track_event::kMoved, track, t);
    } else {
      // What is still coming out from behind something has not been seen to rest.
      const bool is_growing =
          IsPartly(view) && component.cells.size() > track.cells_at_start.size();
      rests =
          t - track.t_start >= (is_growing ? std::max(track.settle, options_.rest) : track.settle);
    }
  } else {
    const EpisodeTime since = t - options_.rest;
    const auto stayed = [&](const Sighting& sighting) {
      return sighting.t < since || (p_WO - sighting.p_WO).norm() < moved_m;
    };
    const std::vector<Sighting>& history = track.object.history;
    rests = history.front().t <= since && track.t_came_out <= since &&
            std::all_of(history.begin(), history.end(), stayed);
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

// What comes from where nobody could see need not come to where nothing was; but it goes.
bool ObjectTracker::HasLeft(const Track& track, const Component& component) const {
  const std::vector<std::size_t>& before = track.cells_at_start;
  const auto least = kSurelyAThing * static_cast<std::size_t>(options_.least_cells);
  if (before.size() < least || component.cells.size() < least) return false;
  const auto count = std::count_if(before.begin(), before.end(), [&](std::size_t cell) {
    return seen_[cell] != 0 &&
           !std::binary_search(component.cells.begin(), component.cells.end(), cell);
  });
  return static_cast<double>(count) >= kLeftShare * static_cast<double>(before.size());
}

Sighting ObjectTracker::See(EpisodeTime t, const Eigen::Vector3d& p_WO) const {
  // Uniform over a cell: off by up to half of one to either side.
  return {t, p_WO, Isotropic(grid_.cell_m / std::sqrt(12.0))};
}

bool ObjectTracker::IsPartly(const View& view) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (view.is_open_low[a] != view.is_open_high[a]) return true;
  }
  return false;
}

bool ObjectTracker::HidesItsLength(const Track& track, const View& view, std::size_t a) {
  const int length = view.cells.last[a] - view.cells.first[a] + 1;
  return length != track.extent[a] && view.is_open_low[a] != view.is_open_high[a];
}

Eigen::Vector3d ObjectTracker::Locate(const Track& track, const View& view) const {
  const Component& component = view.cells;
  const Eigen::Vector3d low = LowCorner(component, grid_);
  const Eigen::Vector3d high = HighCorner(component, grid_);
  const TrackedObject& object = track.object;
  Eigen::Vector3d p_WO = component.centroid_m;
  for (std::size_t a = 0; a < 3; ++a) {
    const bool hides = HidesItsLength(track, view, a);
    const bool sees_low = component.first[a] > 0 && !(hides && view.is_open_low[a]);
    const bool sees_high =
        component.last[a] < grid_.size[a] - 1 && !(hides && view.is_open_high[a]);
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
  track.p_OFirst = grid_.Center(component.first[0], component.first[1], component.first[2]) -
                   component.centroid_m;
  track.shape_cells.clear();
  for (const std::size_t index : component.cells) {
    const std::array<int, 3> cell = grid_.CellAt(index);
    track.shape_cells.push_back(
        {cell[0] - component.first[0], cell[1] - component.first[1], cell[2] - component.first[2]});
  }
  OccupancyGrid shape_O = CutOut(component, grid_);
  shape_O.spec.first_center_m -= component.centroid_m;
  object.field_O = std::make_shared<const SdfGrid>(
      MakeObjectField(shape_O, options_.max_distance_m, options_.convention));
}

}  // namespace sidestep::sdf
