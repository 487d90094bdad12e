#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "sidestep/core/goal.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/plan_request.h"
#include "sidestep/planner/planner.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::planner {

struct ReplannerOptions {
  double horizon_s = 3;  ///< T, a multiple of step_s
  double step_s = 0.1;   ///< between support states
  Eigen::VectorXd q_goal;
  /// A predicted contact is fled from, by a new horizon or by braking, only if it is no further
  /// ahead than this [s], > 0. What is predicted for later is often wrong, and who flees from it
  /// begins again and again: for robots that are stopped anyway before they touch anything.
  double flees_within_s = std::numeric_limits<double>::infinity();
  /// How long the direct motion of the whole way takes [s], for which horizon_s is meant
  /// (Planner::DirectTime_s): an arm that has lost time catches up where it can, as far as what is
  /// left of the way takes less. 0: never.
  double direct_s = 0;

  int num_states() const;  ///< of a whole horizon
};

/// What a cycle may search for, and where each search is to be taken up if the cycle before ran out
/// of budget. Equal for all else.
struct CycleSearches {
  SearchProgress way_out;   ///< from the goal, once the robot has stayed there
  SearchProgress going_on;  ///< from the plan that runs
  SearchProgress anew;      ///< with a new horizon
};

/// All that one planning cycle starts from, as values: it may be worked on in another thread, or
/// again later, and gives the same result.
struct CycleTask {
  EpisodeTime now;
  EpisodeTime t_effect;  ///< when its plan is to take effect
  JointState state;      ///< as measured
  GoalWatch goal;        ///< has been shown what the robot did until now
  std::shared_ptr<const sdf::DistanceField> field;
  std::optional<TimedPlan> running;  ///< what the robot follows
  bool is_braking = false;           ///< what it follows leads to no goal
  PlanBudget budget = {};            ///< of all plans of the cycle together
  CycleSearches searches = {};       ///< as the cycle before left them
};

struct CycleResult {
  /// To be followed from record.t_effect on, if one was found. It agrees with what runs until
  /// then, or it begins then.
  std::optional<TimedPlan> plan;
  bool is_braking = false;  ///< of `plan`
  /// Its status is that of the planner, "braked", or "kept" if nothing was planned; its plan is
  /// the one found, or else the one kept, with that one's clearance from the moment of effect on.
  /// Its objects are left to whoever made the field.
  CycleRecord record;
  CycleSearches searches;
  double optimise_s = 0;  ///< CPU seconds of this thread, for the report only
};

/// One cycle of Algorithm 1 of Finean, Merkt & Havoutis (ICAPS 2021): re-optimise and splice. A
/// function of its arguments.
///
/// Support states stand on a fixed time grid. In each cycle, every state up to the first at or
/// after the moment when the new plan takes effect is held at the running plan's values, so the two
/// agree until then, and the motion is continuous in position and velocity whatever the latency.
/// Each cycle starts from the plan that runs (warm start). A robot without a plan rests until its
/// first one takes effect; one that moves stops meanwhile.
///
/// With fewer than 3 states left to choose, the running plan is kept, unless it does not lead to
/// the goal, though that is not blocked, or is predicted to hit something: then a new horizon
/// begins at the moment of effect, from the state that the robot will have there. Once at rest at
/// the goal, the robot looks one horizon ahead and steps aside likewise; but not before it has
/// dwelt there, unless it would be touched in that time, or no way out would be left after it. A
/// robot found further than 0.1 rad from its plan gets a new horizon from where it will be at the
/// moment of effect if it moves on as it does, within its limits.
///
/// A plan is taken if it is predicted to be free. If it is, but, finished, exceeds a limit that it
/// was asked to keep by more than 5 % or ends short of a goal that is blocked, a new horizon is
/// tried as well, which has more time, and taken if it does neither: where a limit is exceeded,
/// first one that is no longer than what is left takes slowed down by as much, else a whole one. If
/// the plan is not free, two ways out are weighed: a new horizon to the goal, which may have more
/// time and begins with another guess; and to brake (see braking.h) and wait. Then the safest is
/// taken (see clearance.h), and none if going on with what runs is as safe. A robot that brakes or
/// waits looks for new horizons alone.
///
/// An arm that has lost time catches up: where the plan that runs is free and keeps its limits, but
/// ends at least 0.5 s later than a motion at the pace of the task would, one that ends by then is
/// tried, and taken if it does as well and comes no more than 1 cm nearer to what is there. That
/// pace is the horizon's for a direct motion of options.direct_s.
///
/// All searches share the budget. Whether the robot may stay at its goal is not worth more than
/// half of it; nor, where the cycle before came to a new horizon too late, is going on from what
/// runs.
CycleResult RunCycle(const Planner& planner, const ReplannerOptions& options,
                     const CycleTask& task);

/// The times at which the objects of a cycle's field are worth recording: from when the world was
/// observed to the end of the cycle's plan.
std::vector<EpisodeTime> TimesToDescribe(const CycleRecord& record);

}  // namespace sidestep::planner
