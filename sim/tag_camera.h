#pragma once

#include <memory>
#include <vector>

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
/// middle or, if tags have a size, to the corners of a tag that stands there across it. What stands
/// still has no tags: a scan's points are the filled cells of the static world, known beforehand.
///
/// The errors are normal: at distance d of standard deviation across_noise d across the line of
/// sight and along_noise_per_m d^2 along it, and rotation_noise_rad about each axis of the tag. The
/// covariance is that at the measured place, so it is off by as little as the place is.
///
/// What may go wrong besides is no part of the covariance (TagSettings): the middle of a tag that
/// is partly hidden is off by up to half its size across the line of sight; one that flips is
/// turned as if its face (that of the axis of O that points to the camera most) leaned over to the
/// other side of the line of sight as far as it does to this one, about the middle of that face;
/// outliers, swaps and phantoms. Each draws from a stream of its own.
class TagCamera final : public robot::Sensor {
 public:
  /// @param world must outlive this.
  TagCamera(const World& world, const GridSpec& grid, const scenarios::TagSettings& settings,
            double rate_hz, CellRule rule, std::uint64_t seed);

  EpisodeTime NextDue() const override { return clock_.Next(); }
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  // How much of an obstacle's tag is in sight, of 1.
  double ShareInSight(const scenarios::MovingObstacle& obstacle, const Pose& X_WO) const;
  bool IsInSight(const scenarios::MovingObstacle& obstacle, const Eigen::Vector3d& p_W) const;
  // Whether it is found; `is_whole`: all of it.
  bool Finds(const scenarios::MovingObstacle& obstacle, const Pose& X_WO, bool* is_whole);
  ObjectObservation Measure(const scenarios::MovingObstacle& obstacle, const Pose& X_WO,
                            RandomStream* random) const;
  void Misplace(bool is_whole, ObjectObservation* observation);
  void Swap(std::vector<ObjectObservation>* objects);
  void AddPhantom(std::vector<ObjectObservation>* objects);

  const World& world_;
  scenarios::TagSettings settings_;
  CaptureClock clock_;
  RayCaster caster_;
  Eigen::Matrix3Xd p_WStatic_;
  GridSpec grid_;
  RandomStream random_, hidden_, flips_, outliers_, swaps_, phantoms_;
};

/// As a scenario describes it, which must have settings of tags.
std::unique_ptr<robot::Sensor> MakeTagCamera(const scenarios::Scenario& scenario,
                                             const World& world);

}  // namespace sidestep::sim
