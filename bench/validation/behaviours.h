#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Where an obstacle meets the arm, and what the behaviours below are made of.
struct Course {
  Eigen::Vector3d p_WThrough;  ///< [m] on the tool's straight way from start to goal, about
  Eigen::Vector3d across_W;    ///< unit, level: as the scenario's own obstacle goes, about
  Eigen::Vector3d along_W;     ///< unit, level: as the tool goes
  double meets_after_s = 0;    ///< at constant speed it is at p_WThrough then
  double least_way_m = 0;      ///< it comes at least from so far
  double aside_m = 0;          ///< what stands stands so far before p_WThrough
};

/// How an obstacle moves, at most as fast as asked for.
struct Behaviour {
  const char* name;
  const char* meaning;
  /// Its greatest acceleration, in units of what is declared; infinite: it jumps.
  double acceleration_share;
  /// @param acceleration_m_s2 what is declared. The first motion is of the scenario's obstacle, a
  /// second one of another like it.
  std::vector<scenarios::Motion> (*make)(const Course& course, double speed_m_s,
                                         double acceleration_m_s2);
};

/// All there are. To add one: a row of the table in behaviours.cc, and of the groups of matrix.cc.
std::span<const Behaviour> Behaviours();
/// @throws std::invalid_argument for an unknown name.
const Behaviour& BehaviourOf(const std::string& name);

/// Draws one. @param scenario whose first moving obstacle it is to be of.
Course DrawCourse(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                  RandomStream& random);

/// Gives the scenario's first moving obstacle that behaviour, beginning clear of the arm.
void SetBehaviour(const std::string& name, double speed_m_s, std::uint64_t seed,
                  const robot::RobotModel& robot, scenarios::Scenario& scenario);

}  // namespace sidestep::bench
