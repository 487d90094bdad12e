#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "sidestep/core/random.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::imports {

/// A scenario without a task, as one begins: the robot, how it plans and sees, and a workspace that
/// holds all that the arm can reach.
/// @param robot with its base where it is to stand.
scenarios::Scenario DraftScenario(const robot::RobotModel& robot);

/// How far the robot reaches from its base with the surface of any sphere [m].
double ReachOf(const robot::RobotModel& robot);

/// The least time for the straight motion between two configurations that begins and ends at rest
/// (a polynomial of fifth order) within the limits that the scenario lets plans use [s].
double DirectDuration_s(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                        const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to);

/// Makes the horizon as long as the straight motion from start to goal needs, and half as much.
void FitHorizon(scenarios::Scenario& scenario, const robot::RobotModel& robot);

/// What else a configuration has to be.
using IsGood = std::function<bool(const Eigen::VectorXd&)>;

/// Chooses a start, a named configuration if one is free, and a goal that is free too, with a
/// straight way between them; the tool (or the sphere that is farthest out) moves a good part of
/// the reach. False if nothing was found.
bool ChooseTask(scenarios::Scenario& scenario, const robot::RobotModel& robot, RandomStream& random,
                const IsGood& is_good);

/// Chooses a goal alone, from the scenario's start.
bool ChooseGoal(scenarios::Scenario& scenario, const robot::RobotModel& robot, RandomStream& random,
                const IsGood& is_good);

/// Adds a ball that flies level through the middle of the straight motion when that is there, and
/// comes near neither the start at first nor the goal afterwards.
void AddCrossingBall(scenarios::Scenario& scenario, const robot::RobotModel& robot);

}  // namespace sidestep::imports
