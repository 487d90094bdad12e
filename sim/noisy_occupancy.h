#pragma once

#include <memory>

#include "sidestep/core/grid.h"
#include "sidestep/core/random.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/scenarios/sensor_settings.h"

namespace sidestep::sim {

/// An occupancy sensor that errs. In each scan of `sensor`, whose points are centres of filled
/// cells: a point is left out with the probability false_free; the others are displaced by normal
/// noise of position_noise_m along each axis; then each cell that was free in `sensor`'s scan gets
/// a point at its centre with the probability false_filled. All independent of each other and of
/// other scans.
class NoisyOccupancy final : public robot::Sensor {
 public:
  /// @param seed of the episode.
  NoisyOccupancy(std::unique_ptr<robot::Sensor> sensor, const GridSpec& grid,
                 const scenarios::OccupancyNoise& noise, std::uint64_t seed);

  EpisodeTime NextDue() const override { return sensor_->NextDue(); }
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  std::unique_ptr<robot::Sensor> sensor_;
  GridSpec grid_;
  scenarios::OccupancyNoise noise_;
  RandomStream false_free_, position_, false_filled_;
};

}  // namespace sidestep::sim
