#include "sidestep/sim/delayed_sensor.h"

#include <algorithm>
#include <utility>

namespace sidestep::sim {

DelayedSensor::DelayedSensor(std::unique_ptr<robot::Sensor> sensor,
                             const scenarios::SensorSettings& settings, const World& world,
                             std::uint64_t seed)
    : sensor_(std::move(sensor)),
      latency_s_(settings.latency_s),
      jitter_s_(settings.jitter_s),
      dropout_(settings.dropout),
      world_(world),
      jitter_random_(seed, "sensor jitter"),
      dropout_random_(seed, "sensor dropout") {}

EpisodeTime DelayedSensor::NextDue() const {
  const EpisodeTime capture = sensor_->NextDue();
  if (on_their_way_.empty()) return capture;
  return std::min(capture, World::TimeOf(on_their_way_.front().arrival_tick));
}

std::optional<Scan> DelayedSensor::Read(EpisodeTime now) {
  if (std::optional<Scan> scan = sensor_->Read(now)) {
    const double delay_s = latency_s_ + jitter_s_ * jitter_random_.Uniform();
    if (dropout_random_.Uniform() >= dropout_) {
      const std::int64_t tick = World::TickNotBefore(scan->t + HorizonOffset(delay_s));
      const auto after = std::upper_bound(
          on_their_way_.begin(), on_their_way_.end(), tick,
          [](std::int64_t t, const OnItsWay& other) { return t < other.arrival_tick; });
      on_their_way_.insert(after, {tick, std::move(*scan)});
    }
  }
  while (!on_their_way_.empty() && on_their_way_.front().arrival_tick <= world_.ticks()) {
    Scan scan = std::move(on_their_way_.front().scan);
    on_their_way_.erase(on_their_way_.begin());
    if (newest_ && scan.t <= *newest_) continue;
    newest_ = scan.t;
    return scan;
  }
  return std::nullopt;
}

}  // namespace sidestep::sim
