// A sensor that sees perfectly, but only in every other second. Copy this file to sim/ and add the
// line of sensors.def beside it to sim/sensors.def.
#include <cmath>

#include "sidestep/sim/occupancy_sensor.h"

namespace sidestep::sim {
namespace {

class BlinkingSensor final : public robot::Sensor {
 public:
  explicit BlinkingSensor(std::unique_ptr<robot::Sensor> sensor) : sensor_(std::move(sensor)) {}

  EpisodeTime NextDue() const override { return sensor_->NextDue(); }

  std::optional<Scan> Read(EpisodeTime now) override {
    std::optional<Scan> scan = sensor_->Read(now);
    const bool is_shut = scan && std::fmod(scan->t.seconds(), 2) >= 1;
    return is_shut ? std::nullopt : scan;
  }

 private:
  std::unique_ptr<robot::Sensor> sensor_;
};

}  // namespace

std::unique_ptr<robot::Sensor> MakeBlinkingSensor(const scenarios::Scenario& scenario,
                                                  const World& world) {
  return std::make_unique<BlinkingSensor>(std::make_unique<OccupancySensor>(
      world, scenario.grid, scenario.sensor.rate_hz, scenario.sensor.cells));
}

}  // namespace sidestep::sim
