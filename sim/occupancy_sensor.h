#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/capture_clock.h"
#include "sidestep/sim/rasteriser.h"
#include "sidestep/sim/world.h"
#include "sidestep/sim/world_geoms.h"

namespace sidestep::sim {

/// Sees the world as a perfect occupancy grid: a scan holds the centres of the filled cells (see
/// RasteriseWorld), in the world frame.
///
/// A scan shows the world at the moment of Read.
class OccupancySensor final : public robot::Sensor {
 public:
  /// @param world must outlive this.
  /// @throws std::invalid_argument for a rate <= 0 or a bad grid.
  OccupancySensor(const World& world, const GridSpec& spec, double rate_hz, CellRule rule);

  EpisodeTime NextDue() const override { return clock_.Next(); }
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  const World& world_;
  CaptureClock clock_;
  Rasteriser rasteriser_;
  WorldGeoms geoms_;
  OccupancyGrid fixed_;            ///< what never moves, rasterised once
  Eigen::Matrix3Xd fixed_points_;  ///< its cells' centres
};

/// As a scenario describes it, noise and all.
std::unique_ptr<robot::Sensor> MakeOccupancySensor(const scenarios::Scenario& scenario,
                                                   const World& world);

}  // namespace sidestep::sim
