#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "core/recording.h"
#include "core/time.h"
#include "core/trajectory.h"
#include "planner/planner.h"
#include "sdf/world_model.h"

namespace sidestep {

struct ReplannerOptions {
  double horizon_s = 3;  ///< T
  double step_s = 0.1;   ///< between support states
  Eigen::VectorXd q_goal;
};

/// A plan, and when it begins (its support state 0) and takes effect.
struct TimedPlan {
  Trajectory trajectory;
  EpisodeTime start;
};

/// Algorithm 1 of Finean, Merkt & Havoutis (ICAPS 2021): observe, predict, re-optimise, splice.
/// Knows neither a simulator nor hardware: the loop tells it the time, the state and the latency.
///
/// Support states stand on a fixed time grid. In each cycle, every state up to the moment when the
/// new plan takes effect is held at the running plan's values, so that the motion is continuous in
/// position and velocity across the splice, whatever the latency. Each cycle starts from the plan
/// that runs (warm start). When the horizon has run out, it begins anew from the present state.
class Replanner {
 public:
  Replanner(const Planner& planner, WorldModel& world, const ReplannerOptions& options);

  struct Cycle {
    std::optional<TimedPlan> plan;  ///< to submit, if one was found
    CycleRecord record;
    double predict_s = 0;  ///< wall clock, for the report only
    double optimise_s = 0;
  };

  /// One cycle at `now`, whose plan takes effect at now + latency. `state` is the measured state.
  Cycle Run(EpisodeTime now, const JointState& state, HorizonOffset latency);

 private:
  const Planner& planner_;
  WorldModel& world_;
  ReplannerOptions options_;
  std::optional<TimedPlan> running_;
};

}  // namespace sidestep
