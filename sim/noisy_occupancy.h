#pragma once

#include <memory>

#include "core/grid.h"
#include "core/random.h"
#include "robot/sensor.h"
#include "scenarios/sensor_settings.h"

namespace sidestep {

/// An occupancy sensor that errs. In each scan of `sensor`, whose points are centres of filled
/// cells: a point is left out with the probability false_free; the others are displaced by normal
/// noise of position_noise_m along each axis; then each cell that was free in `sensor`'s scan gets
/// a point at its centre with the probability false_filled. All independent of each other and of
/// other scans.
class NoisyOccupancy final : public Sensor {
 public:
  /// @param seed of the episode.
  NoisyOccupancy(std::unique_ptr<Sensor> sensor, const GridSpec& grid, const OccupancyNoise& noise,
                 std::uint64_t seed);

  EpisodeTime NextDue() const override { return sensor_->NextDue(); }
  std::optional<Scan> Read() override;

 private:
  std::unique_ptr<Sensor> sensor_;
  GridSpec grid_;
  OccupancyNoise noise_;
  RandomStream false_free_, position_, false_filled_;
};

}  // namespace sidestep
