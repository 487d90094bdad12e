#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/observations.h"
#include "sidestep/core/time.h"

namespace sidestep::bench {

/// Brings the scans of several sensors, which arrive as late as each of them is, into the order of
/// their capture: that in which a model of the world is told of them (sdf/world_model.h).
///
/// A scan waits until each other sensor has brought one that was captured no earlier, or, since
/// sensors differ in their rates, until one of the same moment would be there if that sensor is as
/// late as it has been at most. So those of a sensor alone never wait, and those of several no
/// longer than the latest of them is late. One that is later than it was before comes too late
/// once. One of the future, by a clock that goes wrong, does not wait for it: who is told of it
/// has to know.
class ScanOrder {
 public:
  /// No scan waits longer than this after its capture, or what is known of the world gets stale.
  static constexpr HorizonOffset kMostLate{0.1};

  /// @param sensors the names of all of them.
  explicit ScanOrder(const std::vector<std::string>& sensors);

  /// A scan has arrived, of a sensor whose scans come in the order of capture.
  /// @return whether it is of use: not if one that was captured no earlier has been taken.
  bool Put(Scan scan, EpisodeTime now);

  /// When there will be something to take, whatever arrives or not; infinite if nothing waits.
  EpisodeTime NextDue() const;

  /// What was captured first, if it need not wait any more: the scans of one moment, in the order
  /// in which they came; else none.
  std::vector<Scan> Take(EpisodeTime now);

 private:
  struct Sensor {
    std::optional<EpisodeTime> newest;  // capture
    HorizonOffset most_late{0};         // from capture to arrival
  };

  struct Waiting {
    Scan scan;
    EpisodeTime arrival;
  };

  EpisodeTime WaitsUntil(const Waiting& one) const;

  std::map<std::string, Sensor> sensors_;
  std::vector<Waiting> waiting_;  // in the order of capture
  std::optional<EpisodeTime> taken_;
};

}  // namespace sidestep::bench
