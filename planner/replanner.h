#pragma once

#include <memory>
#include <optional>

#include "sidestep/core/goal.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/planner.h"
#include "sidestep/planner/replan_cycle.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

/// Keeps the plan that runs from one planning cycle to the next (planner/replan_cycle.h). Knows
/// neither a simulator nor hardware, nor a model of the world: the loop tells it the time, the
/// state, when a plan can take effect, and the field.
class Replanner {
 public:
  /// `planner` is borrowed. @throws std::invalid_argument for options out of range.
  Replanner(const Planner& planner, const ReplannerOptions& options);

  /// What a cycle at `now` starts from. Its plan takes effect at now + latency, but never before a
  /// running plan begins. `state` is the measured state; `goal` has been shown what the robot did
  /// until now, and says how long it is to stay at the goal.
  CycleTask Prepare(EpisodeTime now, const JointState& state, HorizonOffset latency,
                    const GoalWatch& goal, std::shared_ptr<const sdf::DistanceField> field) const;

  /// The work. May run in another thread; of one replanner, one at a time.
  CycleResult Work(const CycleTask& task) const;

  /// The robot has left the plan that ran, and stops: what follows begins where it is.
  void Forget();

  /// The robot follows its plan later than it did, for having slowed down.
  void Delay(HorizonOffset by);

  /// From now on the result's plan is the one that runs, if it has one, and its searches are gone
  /// on with. A result that is not accepted (it came too late) changes nothing.
  void Accept(const CycleResult& result);

 private:
  const Planner& planner_;
  ReplannerOptions options_;
  std::optional<TimedPlan> running_;
  bool is_braking_ = false;
  CycleSearches searches_;  // as the last cycle left them
};

}  // namespace sidestep::planner
