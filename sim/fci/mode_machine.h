#pragma once

#include <optional>

#include "sidestep/robot/fci/errors.h"
#include "sidestep/robot/fci/wire.h"

namespace sidestep::sim::fci {

/// The robot's mode and what may happen in it; no clock, no arm, no network.
///
///   idle -- StartMove --> move -- Finish, StopMove --> idle
///   move -- Abort(errors) --> reflex -- BeginRecovery --> recovery -- EndRecovery --> idle
///   any  -- PressUserStop --> user-stopped -- ReleaseUserStop --> idle
///   idle, move -- BeginGuiding --> guiding -- EndGuiding --> idle
///
/// Whatever ends a motion leaves the status of the Move's last reply in TakeMoveEnd, to be sent
/// after a state that shows the new mode. Sources: libfranka 0.9.2; a user stop sets no error
/// (franka_ros issue 308); settings are taken in idle alone (franka_ros issue 25); what ended the
/// last motion stays until another begins (franka_ros issue 32).
class ModeMachine {
 public:
  robot::fci::RobotMode mode() const { return mode_; }
  bool is_moving() const { return mode_ == robot::fci::RobotMode::kMove; }
  robot::fci::MotionGenerator motion_generator() const { return motion_generator_; }
  robot::fci::Controller controller() const { return controller_; }
  const robot::fci::ErrorSet& errors() const { return errors_; }
  const robot::fci::ErrorSet& last_motion_errors() const { return last_motion_errors_; }

  /// @return kMotionStarted, or why not: kNotPossible in every mode but idle, and for controllers
  /// and motion generators that are not simulated (Cartesian ones); kInvalidArgument for unknown
  /// ones.
  robot::fci::MoveStatus StartMove(const robot::fci::MoveRequest& request);
  void Finish() { EndMotion(robot::fci::MoveStatus::kSuccess, robot::fci::RobotMode::kIdle); }
  /// kSuccess, or kNotPossible where no motion runs.
  std::uint8_t StopMove();
  void Abort(const robot::fci::ErrorSet& errors);
  /// What came over the wire was no number: no reflex, and no error has a name for it.
  void AbortForBadInput();

  void PressUserStop();
  void ReleaseUserStop();
  void BeginGuiding();
  void EndGuiding();

  /// kSuccess: recovers until EndRecovery, or has nothing to recover from; kNotPossible while
  /// somebody holds the stop or the arm; kManualRecoveryRequired if a joint is beyond its limits.
  std::uint8_t BeginRecovery(bool is_within_limits);
  void EndRecovery();

  /// The arm has come to rest: the errors that stopped it are told as the last motion's alone.
  void ClearErrors() { errors_.reset(); }

  /// kSuccess or kNotPossible.
  std::uint8_t MaySet() const;

  /// The status of the Move's last reply, once a motion has ended; each but once.
  std::optional<robot::fci::MoveStatus> TakeMoveEnd();

 private:
  void EndMotion(robot::fci::MoveStatus status, robot::fci::RobotMode next);

  robot::fci::RobotMode mode_ = robot::fci::RobotMode::kIdle;
  robot::fci::MotionGenerator motion_generator_ = robot::fci::MotionGenerator::kIdle;
  robot::fci::Controller controller_ = robot::fci::Controller::kOther;
  robot::fci::ErrorSet errors_, last_motion_errors_;
  std::optional<robot::fci::MoveStatus> move_end_;
};

}  // namespace sidestep::sim::fci
