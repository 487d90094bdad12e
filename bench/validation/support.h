#pragma once

#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "sidestep/bench/validation/item.h"
#include "sidestep/control/tracker.h"

// What items have in common.
namespace sidestep::bench {

/// The name of a row's case.
std::string NameOf(const RunRow& row);

/// Whether a row's obstacles keep to what is declared, nothing fails, and the arm is supervised.
bool IsWithinEnvelope(const RunRow& row);
bool IsOfGroup(const RunRow& row, const char* group);
bool IsEnvelopeOrSoak(const RunRow& row);

using RowTest = std::function<bool(const RunRow&)>;

/// A row and what it tells of one fact.
struct Told {
  const RunRow* row;
  double value;
};
/// Of the rows that have it, those with the largest value first.
std::vector<Told> LargestFirst(const Evidence& evidence, const std::string& fact,
                               const RowTest& filter);
/// The sum over those rows.
double SumOf(const std::vector<Told>& told);

/// The first few that are beyond a limit, or the first one. @param format of fmt, of the value.
std::vector<NamedCase> WorstOf(const std::vector<Told>& told, double limit, const char* format);

/// What an item says where no row tells anything.
ItemFinding NothingRun(const std::string& why);

/// Whether what touches something, or is nearest to it, is the robot's base: that never moves, and
/// no motion of the arm brings it out of the way.
bool IsBase(const robot::RobotModel& robot, const TruthSample& sample);
/// Whether joints of these velocities move: those of an arm at rest are noise.
bool IsMoving(const Eigen::VectorXd& v);
/// Whether the arm is told to move at a tick.
bool IsToldToMove(const ControlSample& tick);
/// How fast the fastest sphere of the arm is told to move at a tick [m/s].
double FastestSphere_m_s(const robot::RobotModel& robot, const ControlSample& tick);

/// How far joints are to be from their ends.
inline constexpr double kLeastJointMargin_rad = 0.1;
/// How much of the robot's velocity limits may be used.
inline constexpr double kMostVelocityShare = 0.5;

/// The tracker that an arm has under the profile `lab`, but for what that keeps in reserve of the
/// joints' ranges and velocities.
control::JerkLimitedTracker LabTracker(const robot::RobotModel& robot);

/// The stop that could begin at a tick.
struct StopFrom {
  Eigen::VectorXd q_end;
  double seconds = 0;
  bool keeps_to_limits = true;
};
StopFrom StopOf(const control::JerkLimitedTracker& tracker, const ControlSample& tick);

/// The greatest way of a part of the arm between two configurations [m], straight.
double GreatestWay(const robot::RobotModel& robot, const Eigen::VectorXd& q_from,
                   const Eigen::VectorXd& q_to);

/// From the arm (its capsules, but for those that never move) to the moving obstacles (the boxes
/// around them, as placed) [m]; infinite without obstacles.
double DistanceToObstacles(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                           const Eigen::VectorXd& q, const std::vector<Pose>& X_WO);

}  // namespace sidestep::bench
