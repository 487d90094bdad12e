#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::bench {

/// What the planner believes at solve `now` of the world at step k >= now: one frozen field a step.
/// Fields must outlive the run, and equal beliefs should be the same object.
using BelievedField = std::function<const sdf::DistanceField&(int now, int k)>;

/// One planning task: from rest to rest.
struct OpenLoopTask {
  Eigen::VectorXd q_start, q_goal;
};

/// What the published tables hold of one run, and a little more.
struct OpenLoopResult {
  /// Verdict `published_states`: at how many support states, start and goal included, a sphere's
  /// centre has a field value below its radius in the true map of that step. Nothing between the
  /// states is looked at, mount spheres are left out, and outside the grid is free.
  int colliding_states = 0;
  double gp_cost = 0;        ///< GP prior and the priors of start and goal
  double obstacle_cost = 0;  ///< all obstacle costs, each in the true map of its step
  int iterations = 0;        ///< Gauss-Newton steps of all solves
  Trajectory trajectory;
};

/// The published open-loop protocol. A motion of num_states states is solved num_states times, by
/// Gauss-Newton from where the solve before ended; before solve i >= 1
///  - state i is pinned where it is, by a prior that stays and keeps its target,
///  - the obstacle costs of steps >= i, with those of the interval that ends at the step, take the
///    field that is believed now.
/// The first solve starts from a straight line, whose velocities are those of the authors: the
/// displacement per state, not per second.
/// @param believed what the planner is told; @param truth the map of each step.
/// @param once stops after the first solve, as the paper's text has it for planners that know the
/// world beforehand.
OpenLoopResult RunOpenLoop(const OpenLoopExperiment& experiment, const robot::RobotModel& robot,
                           const OpenLoopTask& task, const BelievedField& believed,
                           const std::vector<const sdf::DistanceField*>& truth, bool once);

/// Verdict `published_states` of a motion with a state for each map.
int CountCollidingStates(const robot::RobotModel& robot, const Trajectory& trajectory,
                         const std::vector<const sdf::DistanceField*>& truth);

}  // namespace sidestep::bench
