#pragma once

#include <memory>

#include "sidestep/core/grid.h"
#include "sidestep/core/random.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/capture_clock.h"
#include "sidestep/sim/ray_caster.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// A camera that finds a tag in the middle of each moving obstacle, and so says which obstacle it
/// is and where, with the covariance of its error; a model of AprilTag detection, without images.
/// An obstacle is found if it is within range and nothing else stands in the line of sight to its
/// middle. What stands still has no tags: a scan's points are the filled cells of the static world,
/// known beforehand.
///
/// The errors are normal: at distance d of standard deviation across_noise d across the line of
/// sight and along_noise_per_m d^2 along it, and rotation_noise_rad about each axis of the tag. The
/// covariance is that at the measured place, so it is off by as little as the place is.
class TagCamera final : public robot::Sensor {
 public:
  /// @param world must outlive this.
  TagCamera(const World& world, const GridSpec& grid, const scenarios::TagSettings& settings,
            double rate_hz, CellRule rule, std::uint64_t seed);

  EpisodeTime NextDue() const override { return clock_.Next(); }
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  bool Sees(const scenarios::MovingObstacle& obstacle, const Pose& X_WO) const;
  ObjectObservation Measure(const scenarios::MovingObstacle& obstacle, const Pose& X_WO);

  const World& world_;
  scenarios::TagSettings settings_;
  CaptureClock clock_;
  RayCaster caster_;
  Eigen::Matrix3Xd p_WStatic_;
  RandomStream random_;
};

/// As a scenario describes it, which must have settings of tags.
std::unique_ptr<robot::Sensor> MakeTagCamera(const scenarios::Scenario& scenario,
                                             const World& world);

}  // namespace sidestep::sim
