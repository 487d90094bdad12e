#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/robot/fci/errors.h"
#include "sidestep/robot/fci/wire.h"

namespace sidestep::hardware {

/// What a Panda tells of itself each millisecond, of what is used here. rad, rad/s, N m, N.
struct RobotSnapshot {
  std::uint64_t time_ms = 0;  ///< the robot's clock
  robot::fci::Joints q{}, dq{};
  robot::fci::Joints q_d{}, dq_d{}, ddq_d{};  ///< the motion that the robot follows
  robot::fci::Joints tau_J{}, tau_ext{};
  robot::fci::Wrench O_F_ext{};
  robot::fci::Matrix4 O_T_EE{}, F_T_EE{};  ///< column by column
  double load_kg = 0;                      ///< that it is told it carries beside its hand
  robot::fci::RobotMode mode = robot::fci::RobotMode::kOther;
  robot::fci::ErrorSet errors, last_motion_errors;
  double success_rate = 0;  ///< of the last 100 commands
};

/// What a motion consists of.
enum class CommandKind : std::uint8_t { kPositions, kVelocities, kTorques };

/// One millisecond of a motion, of the kind that Control was asked for: rad, rad/s, or N m without
/// gravity.
struct Command {
  robot::fci::Joints values{};
  bool finished = false;  ///< the motion ends here; must be at rest
};

/// A state and how it was answered.
struct ExchangeRecord {
  RobotSnapshot state;
  Command command;
};

/// The robot or the link to it did not do what was asked.
class FciError : public std::runtime_error {
 public:
  enum class Kind : std::uint8_t {
    kNetwork,     ///< nobody there, or gone
    kVersion,     ///< the robot speaks another version of the protocol
    kRefused,     ///< not possible in the robot's mode, or with these values
    kReflex,      ///< the robot has aborted the motion: `errors` says why
    kUserStop,    ///< somebody has pressed the stop
    kPreempted,   ///< stopped by Stop()
    kBadCommand,  ///< what was to be sent is no number
    kAborted,     ///< for another reason
  };

  FciError(Kind kind, const std::string& what, const robot::fci::ErrorSet& errors = {},
           std::vector<ExchangeRecord> log = {})
      : std::runtime_error(what), kind_(kind), errors_(errors), log_(std::move(log)) {}

  Kind kind() const { return kind_; }
  const robot::fci::ErrorSet& errors() const { return errors_; }
  /// The last states of the motion and their answers, oldest first; at most 50.
  const std::vector<ExchangeRecord>& log() const { return log_; }

 private:
  Kind kind_;
  robot::fci::ErrorSet errors_;
  std::vector<ExchangeRecord> log_;
};

/// What a robot is told before it moves.
struct FciSettings {
  robot::fci::Joints stiffness{};  ///< N m/rad
  robot::fci::CollisionBehaviorRequest collision{};
};

/// A Panda behind its control interface: the robot or a server that plays it, by libfranka or by
/// the bare protocol. One thread, but for Stop.
class FciDriver {
 public:
  /// Called once a millisecond of the robot's clock; must return within a fraction of one.
  /// @param elapsed_ms since the last call: 0 at the first, then 1 and one more for each state that
  ///   was lost.
  using NextCommand = std::function<Command(const RobotSnapshot& state, int elapsed_ms)>;

  virtual ~FciDriver() = default;
  virtual int server_version() const = 0;
  /// The state of now. Not while Control runs. @throws FciError, as all below.
  virtual RobotSnapshot ReadOnce() = 0;
  /// Not while a motion runs, nor after an error.
  virtual void Configure(const FciSettings& settings) = 0;
  /// Runs a motion until `next` finishes it. What `next` throws stops the robot and goes through.
  virtual void Control(CommandKind kind, const NextCommand& next) = 0;
  /// Ends the motion: Control throws kPreempted. From any thread; nothing if no motion runs.
  virtual void Stop() = 0;
  /// Out of a reflex, back to idle. Waits until done.
  virtual void Recover() = 0;
};

}  // namespace sidestep::hardware
