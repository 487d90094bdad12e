#include "sidestep/bench/scan_order.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sidestep::bench {

ScanOrder::ScanOrder(const std::vector<std::string>& sensors) {
  for (const std::string& name : sensors) sensors_[name];
}

bool ScanOrder::Put(Scan scan, EpisodeTime now) {
  Sensor& sensor = sensors_.at(scan.sensor);
  sensor.newest = scan.t;
  sensor.most_late = std::min(std::max(sensor.most_late, now - scan.t), kMostLate);
  if (taken_ && scan.t <= *taken_) return false;
  const auto at = std::lower_bound(waiting_.begin(), waiting_.end(), scan,
                                   [](const Scan& a, const Scan& b) { return a.t < b.t; });
  if (at != waiting_.end() && at->t == scan.t) return false;
  waiting_.insert(at, std::move(scan));
  return true;
}

EpisodeTime ScanOrder::WaitsUntil(const Scan& scan) const {
  EpisodeTime until = scan.t;
  for (const auto& [name, sensor] : sensors_) {
    const bool has_come = name == scan.sensor || (sensor.newest && *sensor.newest >= scan.t);
    if (!has_come) until = std::max(until, scan.t + sensor.most_late);
  }
  return until;
}

EpisodeTime ScanOrder::NextDue() const {
  return waiting_.empty() ? EpisodeTime(std::numeric_limits<double>::infinity())
                          : WaitsUntil(waiting_.front());
}

std::optional<Scan> ScanOrder::Take(EpisodeTime now) {
  if (waiting_.empty() || NextDue() > now) return std::nullopt;
  Scan scan = std::move(waiting_.front());
  waiting_.erase(waiting_.begin());
  taken_ = scan.t;
  return scan;
}

}  // namespace sidestep::bench
