#pragma once

#include <array>
#include <functional>
#include <utility>

#include "sidestep/robot/fci/wire.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sim/fci/controller.h"
#include "sidestep/sim/fci/motion_check.h"
#include "sidestep/sim/fci/reflexes.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim::fci {

/// The arm in its world: what the motors do to it, and what its sensors would say. Frames: O the
/// base, F the flange, EE the end effector, K the stiffness frame.
class PandaPlant {
 public:
  /// @param robot the Panda. @param world is stepped by this; must outlive it.
  /// @throws std::invalid_argument for a robot that has not seven joints.
  PandaPlant(const robot::RobotModel& robot, World* world);

  /// Called after each step and each new beginning, by who judges what happens in the world.
  void AfterStep(std::function<void()> call) { after_step_ = std::move(call); }

  /// One tick on. `torque`: of the motors, without gravity, which is added; `disturbance`: what
  /// acts on the joints besides (friction, a ramp), unknown to the controller [N m].
  void Step(const robot::fci::Joints& torque, const robot::fci::Joints& disturbance);

  /// At time 0 again, with the arm where it is, at rest.
  void BeginAnew();

  double time_s() const { return world_.time().seconds(); }
  robot::fci::Joints q() const;
  robot::fci::Joints dq() const;
  robot::fci::Joints holding_torque() const;  ///< that keeps the arm at rest: against gravity
  robot::fci::Joints motor_torque() const;    ///< of the last step, with gravity; not what disturbs

  const JointTable& limits() const { return limits_; }
  JointImpedance impedance() const { return impedance_; }  ///< of robot.yaml

  /// Column by column, with the given F_T_EE.
  robot::fci::Matrix4 O_T_EE(const robot::fci::Joints& q, const robot::fci::Matrix4& F_T_EE) const;

  /// What acts from outside: contacts and end stops during the last step, and its disturbance. The
  /// force at the hand is what explains the joint torques best (damped least squares).
  ExternalForce external() const;
  /// A force at the hand as it would be seen: on the joints too.
  ExternalForce AtTheHand(const robot::fci::Wrench& O_F) const;
  /// Of the hand, in O: velocity [m/s].
  std::array<double, 3> hand_velocity() const;

 private:
  using Jacobian = Eigen::Matrix<double, 6, robot::fci::kNumJoints>;
  Jacobian HandJacobian() const;  ///< in O's axes: linear, then angular

  World& world_;
  robot::RobotModel robot_;
  JointTable limits_;
  JointImpedance impedance_;
  std::array<int, robot::fci::kNumJoints> dofs_{};
  int hand_site_ = 0;
  robot::fci::Joints disturbance_{};
  std::function<void()> after_step_;
};

robot::fci::Matrix4 Identity4();
robot::fci::Matrix4 Product(const robot::fci::Matrix4& A, const robot::fci::Matrix4& B);
/// A rotation and a position: orthonormal to 1e-5, right-handed, last row 0 0 0 1.
bool IsTransform(const robot::fci::Matrix4& T);
/// The hand's frame that the Panda is delivered with: turned by -45 degrees, 0.1034 m out.
/// Source: franka_ros, panda.urdf.xacro (Apache-2.0).
robot::fci::Matrix4 HandFrame();

}  // namespace sidestep::sim::fci
