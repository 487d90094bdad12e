#include "sidestep/sim/delayed_sensor.h"

#include <algorithm>
#include <utility>

namespace sidestep::sim {

DelayedSensor::DelayedSensor(std::unique_ptr<robot::Sensor> sensor,
                             const scenarios::SensorSettings& settings, const World& world,
                             std::uint64_t seed)
    : sensor_(std::move(sensor)), world_(world), line_(settings, seed) {}

EpisodeTime DelayedSensor::NextDue() const {
  const EpisodeTime capture = sensor_->NextDue();
  return std::min(capture, line_.NextArrival().value_or(capture));
}

std::optional<Scan> DelayedSensor::Read(EpisodeTime now) {
  if (std::optional<Scan> scan = sensor_->Read(now)) line_.Send(std::move(*scan));
  return line_.Take(world_.ticks());
}

}  // namespace sidestep::sim
