#include "sidestep/sim/simulated_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace sidestep::sim {
namespace {

std::vector<int> OthersOf(const WorldGeoms& geoms) {
  std::vector<int> others;
  for (const std::vector<int>* some : {&geoms.floor, &geoms.fixed, &geoms.moving}) {
    others.insert(others.end(), some->begin(), some->end());
  }
  return others;
}

// What touches is found by other means than distances are, to within less than this.
constexpr double kSurelyApart_m = 1e-3;

}  // namespace

SimulatedTruth::SimulatedTruth(const World& world)
    : SimulatedTruth(world, FindWorldGeoms(world.model())) {}

SimulatedTruth::SimulatedTruth(const World& world, const WorldGeoms& geoms)
    : world_(world),
      distance_(world.model()),
      robot_shift_(world.model(), geoms.robot),
      other_shift_(world.model(), OthersOf(geoms)) {
  const mjModel& model = world.model();
  for (const int robot_geom : geoms.robot) {
    const int link = model.geom_bodyid[robot_geom];
    for (const int other_geom : OthersOf(geoms)) {
      const int other = model.geom_bodyid[other_geom];
      const bool never_meet = IsFixed(model, link) && IsFixed(model, other);
      if (!never_meet && !IsExcluded(model, link, other)) {
        pairs_.push_back({robot_geom, other_geom});
      }
    }
  }
  Observe();
}

// Most ticks it is enough to know that nothing has come as far as all things were apart.
bool SimulatedTruth::MayTouch() const {
  const double come_m = robot_shift_.Most_m(world_.data()) + other_shift_.Most_m(world_.data());
  return !(clearance_m_ - come_m > kSurelyApart_m);
}

void SimulatedTruth::Observe() {
  const mjModel& model = world_.model();
  const mjData& data = world_.data();
  touching_.clear();
  const Pair* deepest_pair = nullptr;
  Touch deepest;
  deepest.depth_m = -1;
  for (const Pair& pair : std::span(pairs_).first(MayTouch() ? pairs_.size() : 0)) {
    if (distance_.LowerBound(data, pair.robot_geom, pair.other_geom) > 0) continue;
    const auto touch = FindTouch(model, data, pair.robot_geom, pair.other_geom);
    if (!touch) continue;
    touching_.push_back(pair);
    if (touch->depth_m > deepest.depth_m) {
      deepest = *touch;
      deepest_pair = &pair;
    }
  }
  const bool touched_before = pending_.in_contact;
  if (deepest_pair != nullptr) {
    NoteContact(GeomOwner(model, deepest_pair->other_geom), deepest);
  } else {
    NoteSelfContact();
  }
  const bool is_due = world_.ticks() % (World::kTicksPerSecond / kSamplesPerSecond) == 0;
  if (is_due || pending_.in_contact != touched_before) Describe();
  if (is_due) samples_.push_back(std::exchange(pending_, {}));
}

void SimulatedTruth::Describe() {
  pending_.clearance_m = std::numeric_limits<double>::infinity();
  if (touching_.empty()) {
    MeasureDistance();
  } else {
    MeasureDepth();
  }
  clearance_m_ = pending_.clearance_m;
  robot_shift_.Begin(world_.data());
  other_shift_.Begin(world_.data());
  pending_.t = world_.time();
  pending_.X_WO.clear();
  for (const scenarios::MovingObstacle& obstacle : world_.obstacles()) {
    pending_.X_WO.push_back(PoseAt(obstacle, world_.time()));
  }
}

void SimulatedTruth::NoteContact(const std::string& object, const Touch& touch) {
  if (pending_.in_contact) return;  // the first one of the interval is reported
  pending_.in_contact = true;
  pending_.contact_s = world_.time().seconds();
  pending_.contact_object = object;
  pending_.p_WContact = touch.p_WContact;
}

void SimulatedTruth::NoteSelfContact() {
  const mjModel& model = world_.model();
  const mjData& data = world_.data();
  for (int i = 0; i < data.ncon; ++i) {
    const mjContact& contact = data.contact[i];
    const int root1 = model.body_rootid[model.geom_bodyid[contact.geom1]];
    const int root2 = model.body_rootid[model.geom_bodyid[contact.geom2]];
    if (root1 != root2 || contact.exclude != 0 || contact.dist > 0) continue;
    NoteContact(kSelf, {-contact.dist, Eigen::Map<const Eigen::Vector3d>(contact.pos)});
  }
}

void SimulatedTruth::SetClearance(double clearance_m, const Pair& pair) {
  pending_.clearance_m = clearance_m;
  pending_.nearest_robot_part = GeomOwner(world_.model(), pair.robot_geom);
  pending_.nearest_object = GeomOwner(world_.model(), pair.other_geom);
}

void SimulatedTruth::MeasureDepth() {
  for (const Pair& pair : touching_) {
    const double depth = distance_.Depth(world_.data(), pair.robot_geom, pair.other_geom);
    if (0.0 - depth < pending_.clearance_m) SetClearance(0.0 - depth, pair);  // no -0
  }
}

void SimulatedTruth::MeasureDistance() {
  const mjData& data = world_.data();
  std::vector<std::pair<double, const Pair*>> candidates;  // nearest first, by the lower bound
  for (const Pair& pair : pairs_) {
    candidates.emplace_back(distance_.LowerBound(data, pair.robot_geom, pair.other_geom), &pair);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [lower_bound, pair] : candidates) {
    if (lower_bound >= pending_.clearance_m) break;
    const double clearance = distance_.Distance(data, pair->robot_geom, pair->other_geom);
    if (clearance < pending_.clearance_m) SetClearance(clearance, *pair);
  }
}

std::vector<ObjectObservation> SimulatedTruth::ObstaclesAt(EpisodeTime t) const {
  std::vector<ObjectObservation> obstacles;
  for (const scenarios::MovingObstacle& obstacle : world_.obstacles()) {
    ObjectObservation observation;
    observation.id = obstacle.name;
    observation.t = t;
    observation.X_WO = PoseAt(obstacle, t);
    observation.shape = obstacle.shape;
    obstacles.push_back(observation);
  }
  return obstacles;
}

std::optional<TruthSample> SimulatedTruth::ContactSinceLastSample() const {
  if (!pending_.in_contact) return std::nullopt;
  return pending_;
}

std::vector<TruthSample> SimulatedTruth::TakeSamples() { return std::exchange(samples_, {}); }

}  // namespace sidestep::sim
