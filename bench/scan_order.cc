#include "sidestep/bench/scan_order.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace sidestep::bench {
namespace {

constexpr HorizonOffset kOfTheFuture(1e-3);  // further ahead than rounding makes it

}  // namespace

ScanOrder::ScanOrder(const std::vector<std::string>& sensors) {
  for (const std::string& name : sensors) sensors_[name];
}

bool ScanOrder::Put(Scan scan, EpisodeTime now) {
  Sensor& sensor = sensors_.at(scan.sensor);
  sensor.newest = scan.t;
  sensor.most_late = std::min(std::max(sensor.most_late, now - scan.t), kMostLate);
  if (taken_ && scan.t <= *taken_) return false;
  const auto at =
      std::upper_bound(waiting_.begin(), waiting_.end(), scan.t,
                       [](EpisodeTime t, const Waiting& waiting) { return t < waiting.scan.t; });
  waiting_.insert(at, {std::move(scan), now});
  return true;
}

EpisodeTime ScanOrder::WaitsUntil(const Waiting& one) const {
  const EpisodeTime capture = one.scan.t;
  EpisodeTime until = one.arrival;
  if (capture > one.arrival + kOfTheFuture) return until;
  for (const auto& [name, sensor] : sensors_) {
    const bool has_come = sensor.newest && *sensor.newest >= capture;
    if (!has_come) until = std::max(until, capture + sensor.most_late);
  }
  return until;
}

EpisodeTime ScanOrder::NextDue() const {
  return waiting_.empty() ? EpisodeTime(std::numeric_limits<double>::infinity())
                          : WaitsUntil(waiting_.front());
}

std::vector<Scan> ScanOrder::Take(EpisodeTime now) {
  std::vector<Scan> scans;
  if (waiting_.empty() || NextDue() > now) return scans;
  taken_ = waiting_.front().scan.t;
  const auto end = std::find_if(waiting_.begin(), waiting_.end(),
                                [&](const Waiting& one) { return one.scan.t != *taken_; });
  std::transform(waiting_.begin(), end, std::back_inserter(scans),
                 [](Waiting& one) { return std::move(one.scan); });
  waiting_.erase(waiting_.begin(), end);
  return scans;
}

}  // namespace sidestep::bench
