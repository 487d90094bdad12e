#include "sidestep/bench/scan_order.h"

#include <algorithm>
#include <iterator>
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
  const auto at = std::upper_bound(waiting_.begin(), waiting_.end(), scan,
                                   [](const Scan& a, const Scan& b) { return a.t < b.t; });
  waiting_.insert(at, std::move(scan));
  return true;
}

EpisodeTime ScanOrder::WaitsUntil(EpisodeTime capture) const {
  EpisodeTime until = capture;
  for (const auto& [name, sensor] : sensors_) {
    const bool has_come = sensor.newest && *sensor.newest >= capture;
    if (!has_come) until = std::max(until, capture + sensor.most_late);
  }
  return until;
}

EpisodeTime ScanOrder::NextDue() const {
  return waiting_.empty() ? EpisodeTime(std::numeric_limits<double>::infinity())
                          : WaitsUntil(waiting_.front().t);
}

std::vector<Scan> ScanOrder::Take(EpisodeTime now) {
  std::vector<Scan> scans;
  if (waiting_.empty() || NextDue() > now) return scans;
  taken_ = waiting_.front().t;
  const auto end = std::find_if(waiting_.begin(), waiting_.end(),
                                [&](const Scan& scan) { return scan.t != *taken_; });
  std::move(waiting_.begin(), end, std::back_inserter(scans));
  waiting_.erase(waiting_.begin(), end);
  return scans;
}

}  // namespace sidestep::bench
