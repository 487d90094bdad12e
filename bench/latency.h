#pragma once

#include <deque>

#include "sidestep/core/time.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// How long planning cycles take in episode time. A cycle needs to know beforehand when its plan
/// will take effect, because what the robot does until then is settled; what it then took decides
/// whether the plan is there in time.
class LatencyModel {
 public:
  /// As the scenario says: charged, each cycle takes scenario.latency_s; none, no time; measured,
  /// what it really needed.
  explicit LatencyModel(const scenarios::Scenario& scenario);

  /// What the next cycle is expected to take. Measured: half as much again as the longest of the
  /// latest five, at least 1 ms, at most latency_s (or, if that is 0, a period), which the first
  /// cycle gets.
  HorizonOffset Expected() const;

  /// What a cycle takes of virtual time that needed `cpu_s`.
  HorizonOffset Charge(double cpu_s) const;

  /// Learns what one needed, CPU time or, on a wall clock, time.
  void Learn(double needed_s);

 private:
  scenarios::Latency kind_;
  double charged_s_, most_s_;
  std::deque<double> latest_s_;
};

}  // namespace sidestep::bench
