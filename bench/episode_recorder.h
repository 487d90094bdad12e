#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sidestep/bench/episode_world.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Writes down an episode as it goes on, so that what has happened is there however it ends.
class EpisodeRecorder {
 public:
  /// @param robot must outlive it.
  EpisodeRecorder(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                  const EpisodeWorld& world);

  void Keep(ControlSample tick);
  void Keep(TruthSample sample) { recording_.truth.push_back(std::move(sample)); }
  void Keep(CycleRecord cycle) { recording_.cycles.push_back(std::move(cycle)); }
  void Keep(TrackEvent event) { recording_.events.push_back(std::move(event)); }
  void Keep(SafetyEvent event) { recording_.safety.push_back(std::move(event)); }
  /// What sensors captured at one moment is one observation.
  /// @param scans at least one, of one time of capture.
  /// @param changed_cells those that are filled or free now, and were not before these scans, which
  /// had arrived at `t_arrival`; ascending.
  void Keep(const std::vector<Scan>& scans, EpisodeTime t_arrival,
            std::span<const std::size_t> changed_cells);

  const record::Recording& recording() const { return recording_; }
  /// What there is; nothing is kept after that.
  record::Recording Take() { return std::move(recording_); }

 private:
  const robot::RobotModel& robot_;
  record::Recording recording_;
};

}  // namespace sidestep::bench
