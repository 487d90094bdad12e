#pragma once

#include <cstdint>
#include <span>

#include "sidestep/robot/fci/wire.h"
#include "sidestep/sim/fci/controller.h"
#include "sidestep/sim/fci/panda_plant.h"
#include "sidestep/sim/fci/reflexes.h"

namespace sidestep::sim::fci {

/// What a client may set of the robot.
struct PandaSettings {
  JointImpedance impedance;
  robot::fci::CollisionBehaviorRequest collision = DefaultCollisionBehavior();
  robot::fci::Matrix4 NE_T_EE = Identity4(), EE_T_K = Identity4();
  robot::fci::LoadRequest load{};
};

/// Whether there is no NaN and no infinity among what a client sent.
bool AllFinite(std::span<const double> values);

/// Takes what a setter wants, if its values make sense; else nothing is changed.
/// @param request one of the Set... requests, its payload of the right size.
/// @return kSuccess or kInvalidArgument; kNotPossible for any other request.
std::uint8_t Apply(const robot::fci::Message& request, PandaSettings& settings);

}  // namespace sidestep::sim::fci
