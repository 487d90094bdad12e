#include "sidestep/sdf/tracking/named_objects.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sidestep/core/shape.h"
#include "sidestep/sdf/map/object_field.h"

namespace sidestep::sdf {

void NamedObjects::Update(const std::vector<ObjectObservation>& objects, EpisodeTime t) {
  for (const ObjectObservation& seen : objects) {
    const int next_id = -1 - static_cast<int>(ids_.size());
    const int id = ids_.emplace(seen.id, next_id).first->second;
    Track& track = tracks_[id];
    TrackedObject& object = track.object;
    if (object.history.empty()) {
      object.id = id;
      object.first_seen = seen.t;
      object.box_half_extents_m = HalfExtents(seen.shape);
      object.field_O =
          std::make_shared<const SdfGrid>(MakeShapeField(seen.shape, cell_m_, max_distance_m_));
    }
    track.R_WO = seen.X_WO.rotation();
    constexpr double kLeastSigma = 1e-4;  // m; nothing is seen exactly
    const double variance = seen.covariance.topLeftCorner<3, 3>().trace() / 3;
    object.history.push_back(
        {seen.t, seen.X_WO.translation(), std::max(kLeastSigma, std::sqrt(variance))});
    while (seen.t - object.history.front().t > kMemory) {
      object.history.erase(object.history.begin());
    }
  }
  std::erase_if(tracks_, [&](const auto& entry) { return IsForgotten(entry.second.object, t); });
}

bool NamedObjects::IsForgotten(const TrackedObject& object, EpisodeTime t) const {
  if (t - object.latest().t <= kPatience) return false;
  if (!keep_within_) return true;
  const std::array<int, 3> cell = keep_within_->CellOf(object.latest().p_WO);
  return !keep_within_->Contains(cell[0], cell[1], cell[2]);
}

std::vector<NamedObject> NamedObjects::Objects() const {
  std::vector<NamedObject> objects;
  for (auto track = tracks_.rbegin(); track != tracks_.rend(); ++track) {
    objects.push_back(
        {std::make_shared<const TrackedObject>(track->second.object), track->second.R_WO});
  }
  return objects;
}

}  // namespace sidestep::sdf
