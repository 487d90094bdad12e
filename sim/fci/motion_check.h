#pragma once

#include <array>

#include "sidestep/robot/fci/errors.h"
#include "sidestep/robot/fci/wire.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::sim::fci {

/// How long one command holds, and the step of every difference below.
inline constexpr double kTick_s = 0.001;

using JointTable = std::array<robot::JointLimits, robot::fci::kNumJoints>;

/// The motion that the robot follows: what its state tells as q_d, dq_d, ddq_d. rad and s.
struct Reference {
  robot::fci::Joints q{}, dq{}, ddq{};
};

/// What one command makes of the reference. Differences are those of the documented check, backward
/// Euler: dq = (q - q_before) / dt, and ddq likewise.
Reference FollowPositions(const Reference& before, const robot::fci::Joints& q_c);
Reference FollowVelocities(const Reference& before, const robot::fci::Joints& dq_c);
/// Where no command came in time: as if the acceleration stayed as it is.
Reference Extrapolate(const Reference& before);
/// The robot's own stop: the velocity goes to zero at the greatest acceleration.
Reference Brake(const Reference& before, const JointTable& limits);
bool IsAtRest(const Reference& reference);

/// All conditions that the step breaks: position, velocity, acceleration ("velocity discontinuity")
/// and jerk ("acceleration discontinuity") strictly inside the limits. As the robot does, it names
/// all of them: a jump breaks three. What is not a number breaks every one.
/// Source: frankaemika/docs, control_parameters.rst, "Joint trajectory requirements"; that several
/// names come at once: libfranka issue 169.
robot::fci::ErrorSet CheckStep(const Reference& before, const Reference& after,
                               const JointTable& limits);

/// Whether a motion by positions may begin with `q_c`. Too far is what the greatest velocity does
/// not cover in one tick: our choice, the robot's tolerance is not published. Nearer ones are
/// judged by CheckStep, as any other.
robot::fci::ErrorSet CheckStart(const robot::fci::Joints& q_c, const robot::fci::Joints& q_d,
                                const JointTable& limits);

/// Whether a motion may end here: the robot stands still from now on, and the two steps that this
/// takes (velocity, then acceleration to zero) must keep the limits as all others.
robot::fci::ErrorSet CheckEnd(const Reference& last, const JointTable& limits);

}  // namespace sidestep::sim::fci
