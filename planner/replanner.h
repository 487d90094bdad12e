#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "sidestep/core/goal.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/planner/planner.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::planner {

struct ReplannerOptions {
  double horizon_s = 3;  ///< T, a multiple of step_s
  double step_s = 0.1;   ///< between support states
  Eigen::VectorXd q_goal;
};

/// A plan, and when it begins: its state k is at start + t_s(k).
struct TimedPlan {
  Trajectory trajectory;
  EpisodeTime start;
};

/// Algorithm 1 of Finean, Merkt & Havoutis (ICAPS 2021): observe, predict, re-optimise, splice.
/// Knows neither a simulator nor hardware: the loop tells it the time, the state and the latency.
///
/// Support states stand on a fixed time grid. In each cycle, every state up to the first at or
/// after the moment when the new plan takes effect is held at the running plan's values, so the two
/// agree until then, and the motion is continuous in position and velocity whatever the latency.
/// Each cycle starts from the plan that runs (warm start). A robot without a plan rests until its
/// first one takes effect; one that moves stops meanwhile.
///
/// With fewer than 3 states left to choose, the running plan is kept, unless it does not lead to
/// the goal or is predicted to hit something: then a new horizon begins at the moment of effect,
/// from the state that the robot will have there. Once at rest at the goal, the robot looks one
/// horizon ahead and steps aside likewise; but not before it has dwelt there, unless it
/// would be touched in that time, or no way out would be left after it. A robot found further than
/// 0.1 rad from its plan gets a new horizon from where it will be at the moment of effect if it
/// moves on as it does, within its limits.
///
/// A plan is taken if it is predicted to be free. If it is not, two ways out are weighed as well: a
/// new horizon to the goal, which may have more time and begins with another guess; and to brake
/// (see braking.h) and wait. Then the safest is taken (see clearance.h), and none if going on with
/// what runs is as safe. A robot that brakes or waits looks for new horizons alone.
class Replanner {
 public:
  /// `planner` and `world` are borrowed. @throws std::invalid_argument for options out of range.
  Replanner(const Planner& planner, sdf::WorldModel& world, const ReplannerOptions& options);

  struct Cycle {
    /// To be followed from record.t_effect on, if one was found. It agrees with what runs until
    /// then, or it begins then.
    std::optional<TimedPlan> plan;
    /// Its status is that of the planner, "braked", or "kept" if nothing was planned; its plan is
    /// the one found or kept, with that one's clearance from the moment of effect on.
    CycleRecord record;
    double predict_s = 0;  ///< CPU seconds of this thread, for the report only
    double optimise_s = 0;
  };

  /// One cycle at `now`, whose plan takes effect at now + latency, but never before a running plan
  /// begins. `state` is the measured state. The world must have seen a scan. `goal` has been shown
  /// what the robot did until now, and says how long it is to stay at the goal.
  Cycle Run(EpisodeTime now, const JointState& state, HorizonOffset latency, const GoalWatch& goal);

 private:
  /// How the robot will be at `t_effect`: as its plan says, if it follows one.
  TrajectoryPoint Expect(EpisodeTime now, const JointState& state, EpisodeTime t_effect) const;
  /// The request of this cycle; none if the running plan is to be kept.
  std::optional<PlanRequest> MakeRequest(EpisodeTime now, const JointState& state,
                                         EpisodeTime t_effect, const TrajectoryPoint& expected,
                                         const sdf::DistanceField& field) const;
  /// Until when the robot is asked to stay at its goal, where its running plan keeps it as long;
  /// `t_effect` if it is not asked, or is not there.
  EpisodeTime StayUntil(EpisodeTime now, EpisodeTime t_effect, const GoalWatch& goal) const;
  bool RestsAtGoal(const TimedPlan& plan, EpisodeTime from, EpisodeTime to) const;
  /// A whole horizon from `start`.
  PlanRequest NewHorizon(EpisodeTime start, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                         const sdf::DistanceField& field) const;
  bool IsOffPlan(EpisodeTime now, const JointState& state) const;
  /// A whole horizon from `start`: comes to rest, and stays.
  TimedPlan Brake(EpisodeTime start, const TrajectoryPoint& from) const;

  const Planner& planner_;
  sdf::WorldModel& world_;
  ReplannerOptions options_;
  int num_states_;
  std::optional<TimedPlan> running_;
  bool is_braking_ = false;  // what runs leads to no goal
};

}  // namespace sidestep::planner
