#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/robot/sensor.h"
#include "sidestep/scenarios/sensor_settings.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// Any sensor, whose scans arrive late or never: each is lost with the probability `dropout`; the
/// others arrive latency_s plus a uniform part of jitter_s after their capture, rounded up to a
/// tick of the world. A scan that a newer one has overtaken is thrown away, as a driver would do,
/// so scans still come in the order of capture.
class DelayedSensor final : public robot::Sensor {
 public:
  /// @param world must outlive this; its clock says what has arrived.
  DelayedSensor(std::unique_ptr<robot::Sensor> sensor, const scenarios::SensorSettings& settings,
                const World& world, std::uint64_t seed);

  EpisodeTime NextDue() const override;
  std::optional<Scan> Read(EpisodeTime now) override;

 private:
  struct OnItsWay {
    std::int64_t arrival_tick;
    Scan scan;
  };

  std::unique_ptr<robot::Sensor> sensor_;
  double latency_s_, jitter_s_, dropout_;
  const World& world_;
  RandomStream jitter_random_, dropout_random_;
  std::vector<OnItsWay> on_their_way_;  // the first to arrive comes first
  std::optional<EpisodeTime> newest_;   // capture of the newest scan that was delivered
};

}  // namespace sidestep::sim
