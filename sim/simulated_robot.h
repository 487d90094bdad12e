#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "sidestep/control/follower.h"
#include "sidestep/robot/robot_interface.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sim/world.h"

namespace sidestep::sim {

/// The simulated arm, and with AdvanceTo the clock of its world. In each tick of 1 ms:
///   command = what the follower says (control/follower.h), within the robot's limits;
///   torque  = K (q_command - q) + D (v_command - v) + bias, within the motors' limits,
/// with the stiffness K and damping D of robot.yaml, and gravity and Coriolis forces as the bias.
/// The robot's inertia and friction are not compensated, so the arm lags as a real one does.
class SimulatedRobot final : public robot::RobotInterface {
 public:
  /// Holds where the world's arm is now.
  /// @param world is stepped by this; must outlive it.
  /// @param after_tick called after each tick of the world.
  /// @param v_scale of the robot's velocity limits, for the command: above 1 a motion may exceed
  /// them, and the record shows by how much.
  /// @param safety how it is supervised.
  /// @throws std::invalid_argument if the robot has not as many joints as the world's arm, or is to
  /// be supervised and has no capsules.
  SimulatedRobot(const robot::RobotModel& robot, World* world, std::function<void()> after_tick,
                 double v_scale = 1, const control::SafetySettings& safety = {});

  JointState Read() const override;
  robot::RobotStatus Status() const override;
  void Submit(const Trajectory& trajectory, EpisodeTime start) override;
  void Hold() noexcept override;
  void Watch(const ObstacleReport& report) override;
  std::vector<SafetyEvent> TakeSafetyEvents() override;
  /// Steps to the first tick that is not before `t`.
  void AdvanceTo(EpisodeTime t) override;
  /// One sample a tick: command and measurement at its beginning, the torque during it.
  std::vector<ControlSample> TakeControlLog() override;

 private:
  void Tick();

  World& world_;
  std::function<void()> after_tick_;
  Eigen::VectorXd stiffness_, damping_, torque_max_;
  control::Follower follower_;
  control::JointPoint commanded_;  ///< the latest command
  std::vector<ControlSample> log_;
  std::vector<SafetyEvent> safety_events_;
  std::string why_;  ///< it has stopped by itself
};

}  // namespace sidestep::sim
