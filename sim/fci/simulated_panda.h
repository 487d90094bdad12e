#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/robot/fci/errors.h"
#include "sidestep/robot/fci/wire.h"
#include "sidestep/sim/fci/fault_player.h"
#include "sidestep/sim/fci/fault_script.h"
#include "sidestep/sim/fci/mode_machine.h"
#include "sidestep/sim/fci/packet_loss.h"
#include "sidestep/sim/fci/panda_plant.h"
#include "sidestep/sim/fci/panda_settings.h"
#include "sidestep/sim/fci/reflexes.h"

namespace sidestep::sim::fci {

/// The robot behind the wire: takes requests and commands, gives states; knows no sockets and no
/// clock but its own, which Tick moves on by a millisecond.
///
/// The world begins with each client, stands still until the first command of its first motion, and
/// whenever the arm rests after one: what happens in it depends on the commands alone, not on how
/// long a client thinks.
class SimulatedPanda {
 public:
  /// @param plant must outlive this.
  SimulatedPanda(PandaPlant* plant, FaultScript faults);

  /// The world begins at time 0 again, with the arm where it rests and as it is: what a client
  /// meets does not depend on those before it. What was to go wrong goes wrong but once.
  void BeginAnew();

  /// What happens, one line each, for a person.
  void TellWith(std::function<void(const std::string&)> tell) { tell_ = std::move(tell); }

  /// Answers a request, but for Connect, which is the server's. What takes its time is answered
  /// later, by TakeReplies: a recovery, and a Move once more at its end.
  std::optional<robot::fci::Message> Handle(const robot::fci::Message& request);

  /// The state of now. Send it before TakeReplies, which may tell what the state must have shown.
  robot::fci::RobotState State() const;
  std::vector<robot::fci::Message> TakeReplies();

  /// Whether the next tick wants a command that answers State().
  bool awaits_command() const { return modes_.is_moving(); }
  /// Whether a motion has begun whose first command has not come: until then time does not count.
  bool awaits_first_command() const { return modes_.is_moving() && !has_begun_; }
  /// Whether the arm still brakes or settles after a motion: ticks without a client.
  bool is_stopping() const { return !modes_.is_moving() && settle_ticks_ > 0; }
  std::uint64_t message_id() const { return message_id_; }
  /// A client takes no state whose number it has seen; time does not go on by this.
  void NumberAnew() { ++message_id_; }
  double world_time_s() const { return plant_.time_s(); }

  /// A millisecond on. None: no command came in time.
  void Tick(const std::optional<robot::fci::RobotCommand>& command);
  /// The client has gone, or sends nothing at all.
  void LoseClient();

  // What the network does wrong now, for the server to do.
  bool loses_states() const { return faults_.loses_states(); }
  bool TakeLinkCut() { return std::exchange(cuts_link_, false); }

 private:
  void Tell(const std::string& what) const;
  void BeginMove(const robot::fci::Message& request, robot::fci::Message& reply);
  std::uint8_t StopMove();
  std::uint8_t Recover();

  void FollowCommand(const robot::fci::RobotCommand& command);
  void FollowNothing();
  void GoTo(const Reference& next);
  void EndIfFinished(const robot::fci::RobotCommand& command);
  void Abort(const robot::fci::ErrorSet& errors);
  enum class From : std::uint8_t { kReference, kArm };  ///< where a stop begins
  From EndOfReference() const;
  void StopArm(From from);

  void BeginFaults();
  void MoveArm();
  void FeelForces();
  void CheckArm();

  PandaPlant& plant_;
  FaultScript script_;
  FaultPlayer faults_;
  std::function<void(const std::string&)> tell_;

  ModeMachine modes_;
  std::uint64_t message_id_ = 1;
  std::uint32_t move_id_ = 0;
  std::vector<robot::fci::Message> replies_;  ///< of recoveries

  Reference reference_;
  robot::fci::Joints tau_d_{}, tau_J_{}, dtau_J_{};
  PacketLoss loss_;
  bool has_begun_ = false;
  int settle_ticks_ = 0, recovery_ticks_ = 0, held_ticks_ = 0;

  PandaSettings settings_;

  ExternalForce felt_;
  Contacts contacts_;
  std::array<double, 3> hand_velocity_{};

  bool cuts_link_ = false;
};

}  // namespace sidestep::sim::fci
