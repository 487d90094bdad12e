#pragma once

#include "sidestep/robot/fci/errors.h"
#include "sidestep/robot/fci/wire.h"
#include "sidestep/sim/fci/motion_check.h"

namespace sidestep::sim::fci {

/// Gains of the robot's joint impedance: N m/rad and N m s/rad.
struct JointImpedance {
  robot::fci::Joints stiffness{}, damping{};
};

/// The greatest stiffness that SetJointImpedance takes [N m/rad]. Source: libfranka 0.9.2, robot.h.
inline constexpr double kLargestStiffness = 14250;

/// The torque that pulls a joint to the reference [N m]; gravity and Coriolis forces are
/// compensated besides.
robot::fci::Joints ImpedanceTorque(const JointImpedance& gains, const Reference& reference,
                                   const robot::fci::Joints& q, const robot::fci::Joints& dq);

/// Whether an external controller may go from one torque to the next within a tick: the rate must
/// be strictly inside its limit. Source: frankaemika/docs, "Controller requirements". (That the
/// torque itself is inside its limit is only recommended; the motors then give what they can.)
robot::fci::ErrorSet CheckTorque(const robot::fci::Joints& before, const robot::fci::Joints& after,
                                 const JointTable& limits);

}  // namespace sidestep::sim::fci
