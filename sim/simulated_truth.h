#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/robot/world_truth.h"
#include "sidestep/sim/geom_distance.h"
#include "sidestep/sim/geom_shift.h"
#include "sidestep/sim/world.h"
#include "sidestep/sim/world_geoms.h"

namespace sidestep::sim {

/// The verdict, by geometry: contact at every tick, clearance at 100 Hz (first at time 0).
///
/// Judged is every solid of the robot against every other solid: static boxes, floor, moving
/// obstacles. Left out are pairs of bodies that the model excludes from contact (the links at the
/// robot's foot and what it stands on, be it the mount or the floor), and pairs of which neither
/// can move (the bolted base and the tables); against a moving obstacle, the base is judged like
/// any link.
///
/// A contact of the robot with itself counts as contact, with the object "self", where its model
/// lets its links touch. It has no part in the clearance, which is to other things.
class SimulatedTruth final : public robot::WorldTruth {
 public:
  static constexpr int kSamplesPerSecond = 100;
  static constexpr const char* kSelf = "self";

  /// Judges the world as it is now. @param world must outlive this.
  explicit SimulatedTruth(const World& world);

  /// To be called after each tick of the world.
  void Observe();

  std::vector<ObjectObservation> ObstaclesAt(EpisodeTime t) const override;

  /// As WorldTruth says. While pairs touch, clearance_m is minus the depth of
  /// the deepest one (GeomDistance::Depth).
  std::vector<TruthSample> TakeSamples() override;
  std::optional<TruthSample> ContactSinceLastSample() const override;

 private:
  SimulatedTruth(const World& world, const WorldGeoms& geoms);

  struct Pair {
    int robot_geom, other_geom;
  };

  bool MayTouch() const;
  void NoteContact(const std::string& object, const Touch& touch);
  void NoteSelfContact();
  void Describe();
  void MeasureDistance();
  void MeasureDepth();
  void SetClearance(double clearance_m, const Pair& pair);

  const World& world_;
  GeomDistance distance_;
  std::vector<Pair> pairs_;
  std::vector<Pair> touching_;  ///< at the last tick
  /// As measured last, and how far robot and others have moved since then.
  double clearance_m_ = 0;
  GeomShift robot_shift_, other_shift_;
  /// Collects what happens until the next sample; whole as soon as it holds a contact.
  TruthSample pending_;
  std::vector<TruthSample> samples_;
};

}  // namespace sidestep::sim
