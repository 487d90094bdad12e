#pragma once

#include <optional>
#include <vector>

#include "sidestep/control/joint_vector.h"
#include "sidestep/core/obstacle_state.h"
#include "sidestep/hardware/readiness.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::hardware {

/// A person asks for a robot to be taken out of a reflex.
struct RecoveryRequest {
  RobotSnapshot state;
  std::optional<double> since_last_s;    ///< the last recovery of this robot; none: there was none
  std::vector<ObstacleState> obstacles;  ///< what is known to be near
};

/// The distance that a person or a thing that comes at `speed_m_s` is to be kept from a robot that
/// rests and may be set in motion [m]: the way it comes in the time that the robot needs to notice
/// it and to stop, and a margin. Of the separation of ISO/TS 15066 (Marvel & Norcross, Robotics and
/// Computer-Integrated Manufacturing 44, 2017), what is left where the robot does not move.
double ProtectiveDistance(double speed_m_s);

/// Why the robot is not to be recovered: the user stop is pressed or somebody guides the arm,
/// something is nearer than the protective distance, or it was recovered less than a minute ago.
std::optional<Objection> WhyNotRecover(const RecoveryRequest& request,
                                       const robot::RobotModel& robot, double obstacle_speed_m_s);

}  // namespace sidestep::hardware
