#include "sidestep/sdf/tracking/named_objects.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sidestep/core/shape.h"
#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/tracking/object_tracker.h"

namespace sidestep::sdf {
namespace {

constexpr double kLeastSigma = 1e-4;  // m; nothing is seen exactly

Eigen::Matrix3d PositionCovariance(const ObjectObservation& seen) {
  return seen.covariance.topLeftCorner<3, 3>() + Isotropic(kLeastSigma);
}

Sighting SightingOf(const ObjectObservation& seen) {
  return {seen.t, seen.X_WO.translation(), PositionCovariance(seen)};
}

SeenTurn TurnOf(const ObjectObservation& seen) {
  const double variance = seen.covariance.bottomRightCorner<3, 3>().trace();
  return {seen.X_WO.rotation(), std::sqrt(std::max(0.0, variance))};
}

}  // namespace

TagTrackOptions GatesOfTags(double max_speed_m_s, HorizonOffset coast) {
  TagTrackOptions gates;
  gates.sigma_a_m_s2 = 2;
  gates.most_rejects = 4;
  gates.sigma_v_m_s = 2;
  gates.most_speed_m_s = max_speed_m_s;
  gates.most_turn_rad_s = 6;
  gates.patience_s = coast.seconds();
  gates.holds_on = true;
  return gates;
}

void NamedObjects::Update(const std::vector<ObjectObservation>& objects, EpisodeTime t) {
  std::vector<std::pair<Name*, std::vector<const ObjectObservation*>>> seen_of;  // by first mention
  for (const ObjectObservation& seen : objects) {
    const int next_id = -1 - static_cast<int>(names_.size());
    const TagTrack gate(options_.gates.value_or(TagTrackOptions{}));
    Name& name = names_.try_emplace(seen.id, Name{next_id, gate, {}}).first->second;
    const auto same = std::find_if(seen_of.begin(), seen_of.end(),
                                   [&](const auto& entry) { return entry.first == &name; });
    if (same == seen_of.end()) {
      seen_of.push_back({&name, {&seen}});
    } else {
      same->second.push_back(&seen);
    }
  }
  for (auto& [name, candidates] : seen_of) {
    if (!options_.gates) {
      for (const ObjectObservation* const seen : candidates) {
        Track& track = TrackOf(*name, *seen);
        track.R_WO = seen->X_WO.rotation();
        Add(track, SightingOf(*seen));
      }
      continue;
    }
    const auto distance = [&gate = name->gate](const ObjectObservation* seen) {
      return gate.DistanceOf(seen->t, seen->X_WO.translation(), PositionCovariance(*seen));
    };
    const auto best =
        std::min_element(candidates.begin(), candidates.end(),
                         [&](const auto* a, const auto* b) { return distance(a) < distance(b); });
    for (const ObjectObservation* const seen : candidates) {
      if (seen != *best) Note(track_event::kRefused, *name, *seen);
    }
    Take(*name, **best);
  }
  for (auto& [word, name] : names_) name.gate.PassTime(t);
  std::erase_if(tracks_, [&](const auto& entry) { return IsForgotten(entry.second.object, t); });
}

void NamedObjects::Take(Name& name, const ObjectObservation& seen) {
  const Sighting sighting = SightingOf(seen);
  const bool was_followed = name.gate.is_followed();
  const TagTrack::Verdict verdict =
      name.gate.Update(seen.t, sighting.p_WO, sighting.covariance_m2, TurnOf(seen));
  if (!verdict.is_taken) {
    constexpr std::size_t kMostOffered = 16;  // more than any gate begins with
    if (name.offered.size() == kMostOffered) name.offered.erase(name.offered.begin());
    name.offered.push_back(sighting);
    if (was_followed) Note(track_event::kRefused, name, seen);
    // One may be a mistake; what is always so far from where it was is as fast as that.
    constexpr int kInARow = 3;
    name.num_too_fast = verdict.is_too_fast ? name.num_too_fast + 1 : 0;
    if (name.num_too_fast == kInARow) Note(track_event::kTooFast, name, seen);
    return;
  }
  const bool is_new = tracks_.count(name.id) == 0;
  Track& track = TrackOf(name, seen);
  if (verdict.num_begun_with > 0) {
    // It is where these say, whatever was thought before.
    track.object.history.assign(name.offered.end() - (verdict.num_begun_with - 1),
                                name.offered.end());
  }
  name.offered.clear();
  name.num_too_fast = 0;
  track.R_WO = seen.X_WO.rotation();
  // What is unlikely is believed less, here as there.
  Add(track, {sighting.t, sighting.p_WO,
              verdict.num_begun_with > 0 ? sighting.covariance_m2 : verdict.R_m2});
  if (is_new) {
    track.object.first_seen = track.object.history.front().t;
    Note(track_event::kAppeared, name, seen);
  }
}

void NamedObjects::Note(const char* what, const Name& name, const ObjectObservation& seen) {
  events_.push_back({seen.t, what, name.id, 0, seen.X_WO.translation()});
}

NamedObjects::Track& NamedObjects::TrackOf(const Name& name, const ObjectObservation& seen) {
  Track& track = tracks_[name.id];
  TrackedObject& object = track.object;
  if (object.id != 0) return track;
  object.id = name.id;
  object.first_seen = seen.t;
  object.is_filtered = options_.gates.has_value();
  object.box_half_extents_m = HalfExtents(seen.shape);
  object.field_O = std::make_shared<const SdfGrid>(
      MakeShapeField(seen.shape, options_.cell_m, options_.max_distance_m));
  return track;
}

void NamedObjects::Add(Track& track, const Sighting& sighting) const {
  std::vector<Sighting>& history = track.object.history;
  history.push_back(sighting);
  while (sighting.t - history.front().t > kMemory) history.erase(history.begin());
}

bool NamedObjects::HasLeft(const TrackedObject& object) const {
  if (!options_.keep_within) return false;
  const std::array<int, 3> cell = options_.keep_within->CellOf(object.latest().p_WO);
  return !options_.keep_within->Contains(cell[0], cell[1], cell[2]);
}

bool NamedObjects::IsForgotten(const TrackedObject& object, EpisodeTime t) const {
  if (t - object.latest().t <= options_.coast) return false;
  return !options_.keep_within || HasLeft(object);
}

std::vector<NamedObject> NamedObjects::Objects() const {
  std::vector<NamedObject> objects;
  for (auto track = tracks_.rbegin(); track != tracks_.rend(); ++track) {
    objects.push_back({std::make_shared<const TrackedObject>(track->second.object),
                       track->second.R_WO, HasLeft(track->second.object)});
  }
  return objects;
}

}  // namespace sidestep::sdf
