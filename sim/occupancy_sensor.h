#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/grid.h"
#include "robot/sensor.h"
#include "scenarios/scenario.h"
#include "sim/capture_clock.h"
#include "sim/rasteriser.h"
#include "sim/world.h"
#include "sim/world_geoms.h"

namespace sidestep {

/// Sees the world as a perfect occupancy grid: a scan holds the centres of the filled cells (see
/// RasteriseWorld), in the world frame.
///
/// A scan shows the world at the moment of Read.
class OccupancySensor final : public Sensor {
 public:
  /// @param world must outlive this.
  /// @throws std::invalid_argument for a rate <= 0 or a bad grid.
  OccupancySensor(const World& world, const GridSpec& spec, double rate_hz);

  EpisodeTime NextDue() const override { return clock_.Next(); }
  std::optional<Scan> Read() override;

 private:
  const World& world_;
  CaptureClock clock_;
  Rasteriser rasteriser_;
  WorldGeoms geoms_;
  OccupancyGrid fixed_;            ///< what never moves, rasterised once
  Eigen::Matrix3Xd fixed_points_;  ///< its cells' centres
};

/// As a scenario describes it, noise and all.
std::unique_ptr<Sensor> MakeOccupancySensor(const Scenario& scenario, const World& world);

}  // namespace sidestep
