#include "sidestep/bench/latency.h"

#include <algorithm>

namespace sidestep::bench {
namespace {

constexpr std::size_t kRemembered = 5;
constexpr double kReserve = 1.5;
constexpr double kLeast_s = 1e-3;

}  // namespace

LatencyModel::LatencyModel(const scenarios::Scenario& scenario)
    : kind_(scenario.latency),
      charged_s_(scenario.longest_latency_s()),
      most_s_(scenario.latency_s > 0 ? scenario.latency_s : 1 / scenario.replan_rate_hz) {}

HorizonOffset LatencyModel::Expected() const {
  if (kind_ != scenarios::Latency::kMeasured) return HorizonOffset(charged_s_);
  if (latest_s_.empty()) return HorizonOffset(most_s_);
  const double longest_s = *std::max_element(latest_s_.begin(), latest_s_.end());
  return HorizonOffset(std::min(most_s_, std::max(kLeast_s, kReserve * longest_s)));
}

HorizonOffset LatencyModel::Charge(double cpu_s) const {
  return HorizonOffset(kind_ == scenarios::Latency::kMeasured ? cpu_s : charged_s_);
}

void LatencyModel::Learn(double needed_s) {
  latest_s_.push_back(needed_s);
  if (latest_s_.size() > kRemembered) latest_s_.pop_front();
}

}  // namespace sidestep::bench
