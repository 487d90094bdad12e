#include "sidestep/sim/fci/mode_machine.h"

#include <utility>

namespace sidestep::sim::fci {

using robot::fci::Controller;
using robot::fci::MotionGenerator;
using robot::fci::MoveStatus;
using robot::fci::RobotMode;

MoveStatus ModeMachine::StartMove(const robot::fci::MoveRequest& request) {
  constexpr std::uint32_t kControllers = 3, kGenerators = 4;
  if (request.controller >= kControllers || request.motion_generator >= kGenerators) {
    return MoveStatus::kInvalidArgument;
  }
  const auto controller = static_cast<Controller>(request.controller);
  const auto generator = static_cast<MotionGenerator>(request.motion_generator + 1);
  const bool is_simulated = controller != Controller::kCartesianImpedance &&
                            (generator == MotionGenerator::kJointPosition ||
                             generator == MotionGenerator::kJointVelocity);
  if (mode_ != RobotMode::kIdle || !is_simulated) return MoveStatus::kNotPossible;
  mode_ = RobotMode::kMove;
  controller_ = controller;
  motion_generator_ = generator;
  errors_.reset();
  last_motion_errors_.reset();
  return MoveStatus::kMotionStarted;
}

void ModeMachine::EndMotion(MoveStatus status, RobotMode next) {
  if (is_moving()) move_end_ = status;
  mode_ = next;
  motion_generator_ = MotionGenerator::kIdle;
  controller_ = Controller::kOther;
}

std::uint8_t ModeMachine::StopMove() {
  if (!is_moving()) return robot::fci::status::kNotPossible;
  EndMotion(MoveStatus::kPreempted, RobotMode::kIdle);
  return robot::fci::status::kSuccess;
}

void ModeMachine::Abort(const robot::fci::ErrorSet& errors) {
  if (mode_ == RobotMode::kUserStopped) return;
  EndMotion(MoveStatus::kReflexAborted, RobotMode::kReflex);
  errors_ = errors;
  last_motion_errors_ = errors;
}

void ModeMachine::AbortForBadInput() {
  EndMotion(MoveStatus::kInputErrorAborted, RobotMode::kIdle);
}

void ModeMachine::PressUserStop() {
  EndMotion(MoveStatus::kEmergencyAborted, RobotMode::kUserStopped);
  errors_.reset();
}

void ModeMachine::ReleaseUserStop() {
  if (mode_ == RobotMode::kUserStopped) mode_ = RobotMode::kIdle;
}

void ModeMachine::BeginGuiding() {
  if (mode_ == RobotMode::kIdle || is_moving()) {
    EndMotion(MoveStatus::kAborted, RobotMode::kGuiding);
  }
}

void ModeMachine::EndGuiding() {
  if (mode_ == RobotMode::kGuiding) mode_ = RobotMode::kIdle;
}

std::uint8_t ModeMachine::BeginRecovery(bool is_within_limits) {
  if (mode_ == RobotMode::kIdle) return robot::fci::status::kSuccess;
  if (mode_ != RobotMode::kReflex) return robot::fci::status::kNotPossible;
  if (!is_within_limits) return robot::fci::status::kManualRecoveryRequired;
  mode_ = RobotMode::kRecovery;
  return robot::fci::status::kSuccess;
}

void ModeMachine::EndRecovery() {
  if (mode_ != RobotMode::kRecovery) return;
  mode_ = RobotMode::kIdle;
  errors_.reset();
}

std::uint8_t ModeMachine::MaySet() const {
  return mode_ == RobotMode::kIdle ? robot::fci::status::kSuccess
                                   : robot::fci::status::kNotPossible;
}

std::optional<MoveStatus> ModeMachine::TakeMoveEnd() {
  return std::exchange(move_end_, std::nullopt);
}

}  // namespace sidestep::sim::fci
