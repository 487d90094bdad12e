#pragma once

#include "sidestep/robot/fci/errors.h"
#include "sidestep/robot/fci/wire.h"

namespace sidestep::sim::fci {

/// What acts on the arm from outside, as the robot estimates it.
struct ExternalForce {
  robot::fci::Joints tau{};    ///< on the joints [N m]
  robot::fci::Wrench O_F_K{};  ///< at the stiffness frame, in the base's axes [N, N m]
};

/// What is found of it beside the thresholds.
struct Contacts {
  robot::fci::Joints joint_contact{}, joint_collision{};
  robot::fci::Wrench cartesian_contact{}, cartesian_collision{};
  /// joint_reflex or cartesian_reflex where something is above the upper threshold.
  robot::fci::ErrorSet reflexes;
};

/// The thresholds that franka_ros sets at its start, lower and upper alike.
/// Source: franka_control/config/franka_control_node.yaml (Apache-2.0).
robot::fci::CollisionBehaviorRequest DefaultCollisionBehavior();

/// Holds a force against the thresholds, those of acceleration or the nominal ones.
Contacts FindContacts(const ExternalForce& force,
                      const robot::fci::CollisionBehaviorRequest& thresholds, bool is_accelerating);

/// How the estimate follows the force: a low-pass of first order. The robot's own filter is not
/// published; 10 ms is our choice.
inline constexpr double kEstimateTime_s = 0.01;
ExternalForce FilterForce(const ExternalForce& before, const ExternalForce& now);

}  // namespace sidestep::sim::fci
