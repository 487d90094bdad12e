#include "sidestep/bench/clock.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>

namespace sidestep::bench {
namespace {

class VirtualClock final : public Clock {
 public:
  EpisodeTime WaitUntil(EpisodeTime t) override { return now_ = std::max(now_, t); }

 private:
  EpisodeTime now_;
};

class WallClock final : public Clock {
 public:
  EpisodeTime WaitUntil(EpisodeTime t) override {
    using Steady = std::chrono::steady_clock;
    if (!begin_) begin_ = Steady::now();
    std::this_thread::sleep_until(
        *begin_ + std::chrono::ceil<Steady::duration>(std::chrono::duration<double>(t.seconds())));
    const std::chrono::duration<double> passed = Steady::now() - *begin_;
    return std::max(t, EpisodeTime(passed.count()));
  }

 private:
  std::optional<std::chrono::steady_clock::time_point> begin_;
};

}  // namespace

std::unique_ptr<Clock> MakeVirtualClock() { return std::make_unique<VirtualClock>(); }

std::unique_ptr<Clock> MakeWallClock() { return std::make_unique<WallClock>(); }

}  // namespace sidestep::bench
