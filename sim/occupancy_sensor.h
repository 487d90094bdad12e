#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "robot/sensor.h"
#include "sim/rasteriser.h"
#include "sim/world.h"
#include "sim/world_geoms.h"

namespace sidestep {

/// Sees the world as a perfect occupancy grid: a scan holds the centres of the filled cells (see
/// RasteriseWorld), in the world frame.
///
/// Capture k is due at k / rate, rounded up to a tick of the world, so that the world is exactly
/// then what the scan says. A scan shows the world at the moment of Read; captures that were missed
/// by then are skipped.
class OccupancySensor final : public Sensor {
 public:
  /// @param world must outlive this.
  /// @throws std::invalid_argument for a rate <= 0 or a bad grid.
  OccupancySensor(const World& world, const GridSpec& spec, double rate_hz);

  EpisodeTime NextCapture() const override;
  std::optional<Scan> Read() override;

 private:
  std::int64_t TickOfCapture(std::int64_t k) const;

  const World& world_;
  double rate_hz_;
  std::int64_t next_ = 0;  ///< number of the next capture
  Rasteriser rasteriser_;
  WorldGeoms geoms_;
  OccupancyGrid fixed_;            ///< what never moves, rasterised once
  Eigen::Matrix3Xd fixed_points_;  ///< its cells' centres
};

}  // namespace sidestep
