#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/core/time.h"
#include "sidestep/scenarios/sensor_settings.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// What lies between a capture and whoever waits for it. An item, which knows its time of capture
/// `t`, is lost with the probability `dropout`; the others arrive latency_s plus a uniform part of
/// jitter_s after their capture, rounded up to a tick of the world. One that a newer one has
/// overtaken is thrown away, as a driver would do, so items still come in the order of capture.
template <class Item>
class DelayLine {
 public:
  DelayLine(const scenarios::SensorSettings& settings, std::uint64_t seed)
      : latency_s_(settings.latency_s),
        jitter_s_(settings.jitter_s),
        dropout_(settings.dropout),
        jitter_random_(seed, "sensor jitter"),
        dropout_random_(seed, "sensor dropout") {}

  void Send(Item item) {
    const double delay_s = latency_s_ + jitter_s_ * jitter_random_.Uniform();
    if (dropout_random_.Uniform() < dropout_) return;
    const std::int64_t tick = World::TickNotBefore(item.t + HorizonOffset(delay_s));
    const auto after = std::upper_bound(
        on_their_way_.begin(), on_their_way_.end(), tick,
        [](std::int64_t t, const OnItsWay& other) { return t < other.arrival_tick; });
    on_their_way_.insert(after, {tick, std::move(item)});
  }

  /// When the next one arrives, if any is on its way.
  std::optional<EpisodeTime> NextArrival() const {
    if (on_their_way_.empty()) return std::nullopt;
    return World::TimeOf(on_their_way_.front().arrival_tick);
  }

  /// The next one that has arrived by `tick` of the world.
  std::optional<Item> Take(std::int64_t tick) {
    while (!on_their_way_.empty() && on_their_way_.front().arrival_tick <= tick) {
      Item item = std::move(on_their_way_.front().item);
      on_their_way_.erase(on_their_way_.begin());
      if (newest_ && item.t <= *newest_) continue;
      newest_ = item.t;
      return item;
    }
    return std::nullopt;
  }

 private:
  struct OnItsWay {
    std::int64_t arrival_tick;
    Item item;
  };

  double latency_s_, jitter_s_, dropout_;
  RandomStream jitter_random_, dropout_random_;
  std::vector<OnItsWay> on_their_way_;  // the first to arrive comes first
  std::optional<EpisodeTime> newest_;   // capture of the newest that was delivered
};

}  // namespace sidestep::sim
