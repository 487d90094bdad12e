#pragma once

#include <memory>
#include <span>

#include "sidestep/bench/episode_world.h"
#include "sidestep/core/observations.h"
#include "sidestep/core/obstacle_state.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {

/// Follows what moves on behalf of a robot's safety supervisor, whatever the planner is told.
class SafetyWatch {
 public:
  SafetyWatch(const scenarios::Scenario& scenario, const EpisodeWorld& world);

  /// What is known after these scans of one moment.
  ObstacleReport Observe(std::span<const Scan> scans);

 private:
  std::unique_ptr<sdf::WorldModel> model_;
};

}  // namespace sidestep::bench
