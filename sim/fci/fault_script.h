#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/robot/fci/wire.h"

namespace sidestep::sim::fci {

enum class FaultKind : std::uint8_t {
  kLoseCommands,    ///< `count` commands in a row do not arrive
  kLoseStates,      ///< `count` states in a row do not arrive, and so no command comes
  kLoseSome,        ///< each command is lost with probability `rate`
  kUserStop,        ///< somebody presses the stop, for `duration_s`
  kGuiding,         ///< somebody takes the arm by the hand, for `duration_s`; ends a motion
  kError,           ///< a reflex, by its name
  kCutLink,         ///< the TCP connection goes
  kExternalTorque,  ///< on a joint, growing from 0 by `rate` [N m/s] for `duration_s`
  kFriction,        ///< on a joint, against its motion, `torque_n_m`
  kBlockedJoint,    ///< a joint stays where it is
  kTrackingOffset,  ///< the controller holds a joint `offset_rad` beside the reference
};

/// Something that goes wrong at a time. Times count from the first command of the first motion, as
/// long as the arm moves (SimulatedPanda::world_time_s).
struct Fault {
  FaultKind kind = FaultKind::kLoseCommands;
  double at_s = 0, duration_s = 0;
  int count = 0;
  int joint = 0;  ///< 0-based
  int error = 0;
  double rate = 0, torque_n_m = 0, offset_rad = 0;

  bool IsActive(double t_s) const { return at_s <= t_s && t_s < at_s + duration_s; }
};

/// What is wrong with a robot and its network, all of it written down beforehand.
struct FaultScript {
  std::vector<Fault> faults;
  std::uint64_t seed = 1;                        ///< of what is lost by chance
  std::uint16_t version = robot::fci::kVersion;  ///< that the server claims to be
  int refuse_moves = 0;                          ///< so many Moves are not possible
  /// The real estimate of the external force is disturbed by the arm's own motion: by so much for
  /// each m/s and each m/s^2 of the tool, along it.
  double force_per_speed_n_s_m = 0, force_per_acceleration_kg = 0;
};

/// Reads a faults file (its keys: docs/hardware.md). @throws InputError FILE:LINE: KEY: WHY.
FaultScript ReadFaultScript(const std::string& path);
FaultScript ParseFaultScript(const std::string& text, const std::string& name);

}  // namespace sidestep::sim::fci
