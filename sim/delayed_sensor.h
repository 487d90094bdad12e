#pragma once

#include <memory>
#include <optional>

#include "sidestep/robot/sensor.h"
#include "sidestep/scenarios/sensor_settings.h"
#include "sidestep/sim/delay_line.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// Any sensor, whose scans arrive late or never (sim/delay_line.h).
class DelayedSensor final : public robot::Sensor {
 public:
  /// @param world must outlive this; its clock says what has arrived.
  DelayedSensor(std::unique_ptr<robot::Sensor> sensor, const scenarios::SensorSettings& settings,
                const World& world, std::uint64_t seed);

  EpisodeTime NextDue() const override;
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  std::unique_ptr<robot::Sensor> sensor_;
  const World& world_;
  DelayLine<Scan> line_;
};

}  // namespace sidestep::sim
